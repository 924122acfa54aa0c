#pragma once
// A side's triangles with light on them.
//
// Pieces share their vertices and read the irradiance field there once, but for leaves that something stands on or cuts
// through: those have vertices of their own, or light would leak under a wall that stands on a floor. They read the
// field a little inside of their corners, which lie in what cuts them.
#include "render/reconstruction.hpp"
#include "render/solution_mesh/side_shape.hpp"

namespace deltalux::rendering {

/// With versions of 0.
SurfaceMesh litSide(const SideShape&, const Scene&, const Reconstruction&);

bool sameShape(const SurfaceMesh&, const SurfaceMesh&);
/// Of sides of the same shape.
bool sameLight(const SurfaceMesh&, const SurfaceMesh&);

}  // namespace deltalux::rendering
