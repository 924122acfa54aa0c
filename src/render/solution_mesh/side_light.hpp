#pragma once
// A side's triangles with light on them.
//
// Pieces share their vertices and read the irradiance field there once, but for leaves that something stands on or cuts
// through: those have vertices of their own, or light would leak under a wall that stands on a floor. They read the
// field a little inside of their corners, which lie in what cuts them.
#include "render/reconstruction.hpp"
#include "render/solution_mesh/side_shape.hpp"

namespace deltalux::rendering {

/// Where the vertices of a side read the field, and which of its parts had torn leaves then.
struct SideReading {
  /// No leaf: the vertex is dark.
  struct Place {
    hierarchy::ElementId leaf;
    Vec3f position;
  };
  std::vector<Place> places;  // by vertex
  std::vector<char> torn;     // by part

  /// Whether vertices of that shape would still read there.
  bool holds(const SideShape&, const IrradianceField&) const;
};

/// With versions of 0. `before`: the same side (or null) as it was read from field number `generation`: light is taken
/// from there where it has not changed. `reading`: is set to where it is read.
SurfaceMesh litSide(const SideShape&, const Scene&, const Reconstruction&, const SurfaceMesh* before,
                    std::uint64_t generation, SideReading& reading);
/// The same for a side whose reading holds.
SurfaceMesh litAgain(const SurfaceMesh& before, const SideReading&, const SideShape&, const Scene&,
                     const Reconstruction&, std::uint64_t generation);
/// Whether that would give `before`, which is of the same shape; does not look further than it must.
bool isStillLit(const SideShape&, const Scene&, const Reconstruction&, const SurfaceMesh& before,
                std::uint64_t generation);

bool sameShape(const SurfaceMesh&, const SurfaceMesh&);
/// Of sides of the same shape.
bool sameLight(const SurfaceMesh&, const SurfaceMesh&);

}  // namespace deltalux::rendering
