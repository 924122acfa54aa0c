#pragma once
// The triangles of a side, without light: what of a SurfaceMesh depends on patches and shapes alone.
//
// A piece becomes a fan of triangles about its centre; triangles of meshes stay whole, what no light is known of and
// outlines that no fan fits are triangulated as they are.
#include <deltalux/solution_mesh.hpp>
#include <memory>
#include <optional>

#include "render/solution_mesh/surface_pieces.hpp"

namespace deltalux::rendering {

struct SideShape {
  /// A piece: its ranges in `triangles` and `outlines`.
  struct Part {
    hierarchy::ElementId leaf;
    std::uint32_t triangles = 0, trianglesEnd = 0, outlines = 0, outlinesEnd = 0;
  };
  PrimitiveId primitive;
  bool front = true;
  std::vector<MeshVertex> points;  // each once; without light. Of curved surfaces `uv` is where it is read
  std::vector<Part> parts;
  std::vector<std::uint32_t> triangles, outlines;  // as SurfaceMesh has them
  std::optional<Mat4> lag;                         // as SurfacePieces: from the points to where light is read
};

/// The shapes of sides that share points: precondition that flat ones and curved ones are not mixed, and that there is
/// one curved one at most. `touching`: points nearer than this are one.
std::vector<std::shared_ptr<const SideShape>> shapesOf(const std::vector<const SurfacePieces*>&, const Scene&,
                                                       double touching);

}  // namespace deltalux::rendering
