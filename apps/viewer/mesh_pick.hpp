#pragma once
// What a ray meets first on a mesh snapshot: for the cursor, which cannot wait for the solver.
#include <deltalux/solution_mesh.hpp>
#include <deltalux/solution_reader.hpp>
#include <optional>

namespace deltalux::viewer {

struct MeshHit {
  SurfaceHit surface;    // on the shape itself, where it is a curved one
  Rgb irradiance{0.0f};  // E that the mesh shows there, without caustic textures [W/m2]
};

class MeshPick {
 public:
  /// Takes over the snapshot: boxes of sides that have another shape than before. Snapshots are of one reader.
  void follow(std::shared_ptr<const SolutionMesh>);
  /// The first triangle that faces the ray, within `within` if given. Cost: a look at every side's box, and at the
  /// triangles of those that are met. `direction` is unit.
  std::optional<MeshHit> first(const Vec3& origin, const Vec3& direction, const std::optional<Box>& within) const;

 private:
  struct Side {
    Box box;
    std::uint64_t version = 0;
  };
  std::shared_ptr<const SolutionMesh> mesh_;
  std::vector<Side> sides_;
};

}  // namespace deltalux::viewer
