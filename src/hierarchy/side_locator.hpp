#pragma once
// From a point of a surface to the element that holds it: the lowest element that holds all of the surface's side, and
// down its quadtree to the leaf. Cost: a handful of comparisons a level, no memory per query.
#include "hierarchy/plane_points.hpp"

namespace deltalux::hierarchy {

/// A leaf patch and the parameters of a point on its primitive (of its triangle, for meshes; of leaves of many faces
/// they are not known).
struct LeafPoint {
  ElementId leaf;
  Vec2 uv{0};
};

class SideLocator {
 public:
  /// Both must outlive this.
  SideLocator(const Elements&, const Scene&);

  /// As Elements::side().
  ElementId side(PrimitiveId primitive, std::uint32_t triangle, bool front) const {
    return elements_.side(primitive, triangle, front);
  }
  /// The leaf under `side` whose domain holds the surface point `p`, or is nearest to it.
  LeafPoint locate(ElementId side, const Vec3& p) const;
  /// The same for parameters that are known.
  ElementId leafAt(ElementId side, const Vec2& uv) const;

 private:
  const Elements& elements_;
  const Scene& scene_;
  std::vector<PlanePoints> planes_;  // per frame
};

}  // namespace deltalux::hierarchy
