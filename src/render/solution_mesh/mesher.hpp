#pragma once
// Makes snapshots of a solution as triangles, one after the other: what a snapshot has in common with the one before is
// shared with it, and what has not changed is not made again.
//
// A side is cut into pieces anew when it has moved or has other leaves; a group of sides (plane_groups.hpp) is joined
// anew when any of its sides is. Light is read where the field has changed. The result is that of a new mesher.
// Cost: a visit per leaf, 0.4 microseconds a vertex with other light, and some 10 microseconds a leaf whose group has
// changed.
#include "caustics/caustics.hpp"
#include "render/leaf_sites.hpp"
#include "render/solution_mesh/side_light.hpp"
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
  /// What the pieces of a side follow from, besides its shape.
  struct Cut {
    std::vector<hierarchy::ElementId> leaves;
    int steps = -1;
    std::optional<Mat4> lag = std::nullopt;

    bool operator==(const Cut&) const = default;
  };
  /// Which sides are to be cut anew, and which primitives have moved: all at first.
  std::vector<char> findChanged(const Solution&);
  void findShapes(const Solution&, const std::vector<char>& changed);
  std::shared_ptr<const SurfaceMesh> surfaceAt(std::size_t side, const Solution&, const Reconstruction&,
                                               const SolutionMesh& before, std::uint64_t version);
  std::shared_ptr<const SurfaceCausticMesh> causticsAt(std::size_t side, const Solution&, const SurfaceMesh*,
                                                       const SolutionMesh& before, std::uint64_t version);

  std::shared_ptr<const Scene> scene_;
  Standing standing_;                               // of the snapshot before
  std::vector<std::vector<std::uint32_t>> groups_;  // sides that share points
  std::vector<Cut> cuts_;                           // by side
  std::vector<SurfacePieces> pieces_;               // the same
  std::vector<std::shared_ptr<const SideShape>> shapes_;
  std::vector<SideReading> readings_;  // by side, of the snapshot before
  std::vector<char> reshaped_;         // by side: has another shape than the snapshot before
  std::vector<std::shared_ptr<const caustics::SurfaceCaustics>> sources_;  // by side, of its caustic textures
  std::uint64_t generation_ = 0;  // of the field that the snapshot before was read from
};

}  // namespace deltalux::rendering
