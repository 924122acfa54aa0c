#pragma once
// Builds the element hierarchy over the sides of a scene's surfaces that light can reach: a bounding-volume hierarchy
// of clusters whose large surfaces stay high, so that a wall does not widen every cluster along it (attach a surface to
// the lowest cluster that fits it [Christensen95 6.7]); the area emitters in a tree of their own.
// Cost: O(n log n) over input-level surfaces; meshes take part by triangle, so clusters within a mesh do the work, or
// by patches of many faces.
#include "hierarchy/element.hpp"
#include "hierarchy/input_level.hpp"

namespace deltalux::hierarchy {

/// One side of an input-level surface, and what is known of it before any link exists.
struct SurfaceSide {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;  // of a mesh
  bool front = true;
  float meanFreePath = 0.0f;       // mean distance to what it sees [scene units]
  Rgb irradiance{0.0f};            // first estimate [W/m2]
  float typicalIrradiance = 0.0f;  // gray; a mean over the surface that favours its dark parts
  std::uint32_t order = 0;         // of many faces of a fine mesh, as PatchDomain has them
  FaceRange faces{};

  Side side() const { return {primitive, triangle, front}; }
};

/// Both sides of every surface, one of each pane and body of glass (which has no diffuse side, but blocks). Meshes give
/// their triangles. Fields that need rays are left at zero.
std::vector<SurfaceSide> surfaceSides(const Scene&);
/// The same, but for fine meshes patches of many faces, by their orders.
std::vector<SurfaceSide> surfaceSides(const Scene&, std::span<const FaceOrder>);

/// visit(Side) of those of one primitive.
template <class Visit>
void forEachSide(const Scene& scene, PrimitiveId primitive, const Visit& visit) {
  const Shape& shape = scene[primitive].shape;
  if (!(area(shape) > 0)) return;
  const bool clear = isClear(scene.materialOf(primitive));
  const auto* mesh = std::get_if<Mesh>(&shape);
  const auto triangles = static_cast<std::uint32_t>(mesh ? mesh->triangles.size() : 1);
  for (std::uint32_t t = 0; t < triangles; ++t) {
    visit(Side{primitive, t, true});
    if (!clear) visit(Side{primitive, t, false});
  }
}

/// `orders`: those by which patches of many faces are among the sides.
Elements buildElements(const Scene&, const std::vector<SurfaceSide>& reachable, std::vector<FaceOrder> orders = {});

/// Their elements, inactive or not; none where there are none.
std::vector<ElementId> elementsOf(const Elements&, std::span<const SurfaceSide>);
/// Gives sides that have none yet elements, below a root of their own, which is returned: what edits uncover or add. In
/// the order of surfaceSides(), at least one.
ElementId growElements(Elements&, const Scene&, const std::vector<SurfaceSide>&);

}  // namespace deltalux::hierarchy
