#include "hierarchy/side_locator.hpp"

#include <algorithm>

namespace deltalux {

namespace {
std::size_t surfacesOf(const Shape& shape) {
  const auto* mesh = std::get_if<Mesh>(&shape);
  return mesh ? mesh->triangles.size() : 1;
}
}  // namespace

SideElements::SideElements(const Elements& elements, const Scene& scene) {
  first_.reserve(scene.primitives.size() + 1);
  std::size_t total = 0;
  for (const Primitive& p : scene.primitives) {
    first_.push_back(static_cast<std::uint32_t>(total));
    total += 2 * surfacesOf(p.shape);
  }
  first_.push_back(static_cast<std::uint32_t>(total));
  sides_.resize(total);
  for (const ElementId e : elements.inputs) {
    if (!elements.receives(e)) continue;
    const PatchDomain& d = elements.domain[e.index()];
    const std::size_t at = indexOf(d.primitive, d.triangle, elements.at(e).front);
    if (at < sides_.size()) sides_[at] = e;
  }
}

SideLocator::SideLocator(const Elements& elements, const Scene& scene)
    : SideElements(elements, scene), elements_(elements), scene_(scene) {
  for (const PlaneFrame& f : elements.frames) {
    const Vec3 n = glm::cross(f.edgeU, f.edgeV);
    const double squared = std::max(glm::dot(n, n), 1e-300);
    dualU_.push_back(glm::cross(f.edgeV, n) / squared);
    dualV_.push_back(glm::cross(n, f.edgeU) / squared);
    origin_.push_back(f.origin);
  }
}

/// Beyond all sides for surfaces that were removed: their elements stay, without a shape.
std::size_t SideElements::indexOf(PrimitiveId primitive, std::uint32_t triangle, bool front) const {
  const std::size_t at = first_[primitive.index()] + 2 * std::size_t(triangle) + (front ? 0 : 1);
  return at < first_[primitive.index() + 1] ? at : sides_.size();
}

ElementId SideElements::side(PrimitiveId primitive, std::uint32_t triangle, bool front) const {
  const std::size_t at = indexOf(primitive, triangle, front);
  return at < sides_.size() ? sides_[at] : ElementId();
}

LeafPoint SideLocator::locate(ElementId side, const Vec3& p) const {
  const PatchDomain& d = elements_.domain[side.index()];
  LeafPoint result;
  if (elements_.at(side).flat) {
    const Vec3 from = p - origin_[d.frame];
    result.uv = {glm::dot(from, dualU_[d.frame]), glm::dot(from, dualV_[d.frame])};
  } else {
    result.uv = parameterAt(scene_[d.primitive].shape, p, d.triangle);
  }
  result.leaf = leafAt(side, result.uv);
  return result;
}

ElementId SideLocator::leafAt(ElementId e, const Vec2& uv) const {
  const float u = static_cast<float>(uv.x), v = static_cast<float>(uv.y);
  while (!elements_.isLeaf(e)) {
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

}  // namespace deltalux
