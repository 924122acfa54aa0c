#pragma once
// A solution's mesh whose direct light of suns and lamps was measured (refine.hpp): what the mesh keeps, and what is
// measured, to be read at any point of its sides.
#include <deltalux/solution_mesh.hpp>
#include <memory>

#include "base/box_tree.hpp"
#include "export/refine.hpp"

namespace deltalux::exporting {

/// Direct light of one side, linear on triangles of its own.
class SideDirect {
 public:
  SideDirect(std::vector<Vec3f> corners, std::vector<std::array<std::uint32_t, 3>> triangles, std::vector<Rgb> light);

  /// E at the nearest of its triangles within `reach` of the point; nullopt: there is none [W/m2].
  std::optional<Rgb> at(const Vec3f& position, float reach) const;

 private:
  std::vector<Vec3f> corners_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  std::vector<Rgb> light_;
  BoxTree tree_;
};

struct MeasuredLight {
  SolutionMesh mesh;                                     // less what was measured
  std::vector<std::shared_ptr<const SideDirect>> sides;  // by side; null: nothing was
};

/// `mesh` is of the solution, which has its light as it is now: all of it, or that of a group (lightOf()). With skies
/// that the solution does not hold apart nothing is measured. `error`: of all light at a place.
MeasuredLight measuredLight(const SolutionView&, const SolutionMesh& mesh, double error);

}  // namespace deltalux::exporting
