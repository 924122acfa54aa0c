#include "hierarchy/side_locator.hpp"

#include <algorithm>

namespace deltalux::hierarchy {

SideLocator::SideLocator(const Elements& elements, const Scene& scene)
    : elements_(elements), scene_(scene), planes_(elements.frames.begin(), elements.frames.end()) {}

LeafPoint SideLocator::locate(ElementId side, const Vec3& p) const {
  const PatchDomain& d = elements_.domain[side.index()];
  LeafPoint result;
  if (elements_.hasFaces(side)) {
    result.leaf = side;
    return result;
  }
  result.uv = elements_.at(side).flat ? planes_[d.frame].of(p) : parameterAt(scene_[d.primitive].shape, p, d.triangle);
  result.leaf = leafAt(side, result.uv);
  return result;
}

ElementId SideLocator::leafAt(ElementId e, const Vec2& uv) const {
  const float u = static_cast<float>(uv.x), v = static_cast<float>(uv.y);
  while (!elements_.isLeaf(e) && !elements_.hasFaces(e)) {
    ElementId nearest;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < elements_.at(e).childCount && least > 0; ++i) {
      const ElementId c = elements_.child(e, i);
      const PatchDomain& d = elements_.domain[c.index()];
      // Quadrants outside the outline have no element: a point on the rim may fall just beyond those that do.
      const float outside = std::max({d.u0 - u, u - d.u1, 0.0f}) + std::max({d.v0 - v, v - d.v1, 0.0f});
      if (outside < least) least = outside, nearest = c;
    }
    e = nearest;
  }
  return e;
}

}  // namespace deltalux::hierarchy
