#pragma once
// What the caustic textures of a side show at its points.
#include <deltalux/solution_mesh.hpp>
#include <vector>

#include "base/box_tree.hpp"

namespace deltalux::exporting {

class LightmapCaustics {
 public:
  /// Keeps a reference. Cost: n log n in the triangles that show the textures.
  explicit LightmapCaustics(const SurfaceCausticMesh&);

  /// E there [W/m2]; 0 where no texture shows anything. `reach`: how far off the triangles a point may lie.
  Rgb at(const Vec3f& position, float reach) const;
  /// Size of a texel, the median over the textures [scene units].
  double texelSize() const { return texelSize_; }

 private:
  struct Triangle {
    std::uint32_t texture = 0, first = 0;  // its first index in the texture's triangles
  };

  const SurfaceCausticMesh& caustics_;
  std::vector<Triangle> triangles_;
  BoxTree tree_;
  double texelSize_ = 0;
};

}  // namespace deltalux::exporting
