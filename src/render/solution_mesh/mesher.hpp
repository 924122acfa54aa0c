#pragma once
// Makes snapshots of a solution as triangles, one after the other: what a snapshot has in common with the one before is
// shared with it, and what has not changed is not made again.
//
// Pieces of every side are listed anew each time, which is cheap, and compared with those of the snapshot before: only
// groups of sides (plane_groups.hpp) with other pieces are joined anew. Light is read at every vertex.
// Cost: a visit per leaf, 0.4 microseconds a vertex, and some 10 microseconds a leaf whose group has changed.
#include "render/solution_mesh/side_shape.hpp"

namespace deltalux {

struct Solution;

}  // namespace deltalux

namespace deltalux::rendering {

struct Reconstruction;

class SolutionMesher {
 public:
  /// The snapshot numbered `version`. `before`: the snapshot that this mesher made last, or an empty one.
  SolutionMesh snapshot(const Solution&, const Reconstruction&, const SolutionMesh& before, std::uint64_t version);

 private:
  void findGroups(const Scene&);
  void findShapes(const Solution&);

  std::shared_ptr<const Scene> scene_;              // that the groups are of
  std::vector<std::vector<std::uint32_t>> groups_;  // sides that share points
  std::vector<SurfacePieces> pieces_;               // by side
  std::vector<std::shared_ptr<const SideShape>> shapes_;
};

}  // namespace deltalux::rendering
