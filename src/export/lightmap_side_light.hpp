#pragma once
// Irradiance that the mesh of a side has at any point of it.
#include <deltalux/solution_mesh.hpp>
#include <optional>

#include "base/box_tree.hpp"

namespace deltalux::exporting {

/// Direct, indirect and particles of a vertex [W/m2].
inline Rgb irradianceOf(const MeshVertex& v) { return v.direct + v.indirect + v.particle; }

/// Weights of the second and third corner of the point's foot on a triangle; nullopt: it lies outside, or further off
/// its plane than `reach`.
std::optional<glm::vec2> weightsOn(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& p, float reach);

class SideLight {
 public:
  /// Keeps a reference. Cost: n log n in its triangles.
  explicit SideLight(const SurfaceMesh&);

  /// E [W/m2], without caustic textures; nullopt: no triangle lies within `reach`.
  std::optional<Rgb> at(const Vec3f& position, float reach) const;

 private:
  const SurfaceMesh& side_;
  BoxTree tree_;
};

}  // namespace deltalux::exporting
