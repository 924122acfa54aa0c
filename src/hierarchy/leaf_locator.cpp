#include "hierarchy/leaf_locator.hpp"

#include <algorithm>

#include "hierarchy/below.hpp"

namespace deltalux::hierarchy {

LeafLocator::LeafLocator(const Elements& elements, const Scene& scene, const LeafTable& leaves)
    : elements_(elements), scene_(scene), planeOf_(elements.size(), LeafTable::kNone) {
  const auto addSide = [&](ElementId input) {
    Plane plane;
    plane.flat = elements.at(input).flat;
    if (plane.flat) {
      const PlaneFrame& f = elements.frames[elements.domain[input.index()].frame];
      const Vec3 n = glm::cross(f.edgeU, f.edgeV);
      const double squared = std::max(glm::dot(n, n), 1e-300);
      plane.origin = f.origin;
      plane.dualU = glm::cross(f.edgeV, n) / squared, plane.dualV = glm::cross(n, f.edgeU) / squared;
    }
    plane.root = add(input, elements, leaves);
    planeOf_[input.index()] = static_cast<std::uint32_t>(planes_.size());
    planes_.push_back(plane);
  };
  for (const ElementId input : elements.inputs) {
    if (!elements.receives(input)) continue;
    forEachBelow(elements, input, [&](ElementId e) {
      const bool split = elements.hasFaces(e) && !elements.isLeaf(e);
      if (!split) addSide(e);
      return split;
    });
  }
}

std::int32_t LeafLocator::add(ElementId e, const Elements& elements, const LeafTable& leaves) {
  if (elements.isLeaf(e)) return ~static_cast<std::int32_t>(leaves.indexOf[e.index()]);
  const PatchDomain& whole = elements.domain[e.index()];
  Node node{whole.u1, whole.v1, {0, 0, 0, 0}};
  for (std::size_t i = 0; i < elements.at(e).childCount; ++i) {
    const PatchDomain& d = elements.domain[elements.child(e, i).index()];
    if (d.u0 > whole.u0) node.u = d.u0;
    if (d.u1 < whole.u1) node.u = d.u1;
    if (d.v0 > whole.v0) node.v = d.v0;
    if (d.v1 < whole.v1) node.v = d.v1;
  }
  const std::size_t at = nodes_.size();
  nodes_.push_back(node);
  bool has[4] = {false, false, false, false};
  for (std::size_t i = 0; i < elements.at(e).childCount; ++i) {
    const ElementId child = elements.child(e, i);
    const PatchDomain& d = elements.domain[child.index()];
    const std::int32_t below = add(child, elements, leaves);
    for (int q = 0; q < 4; ++q) {
      const bool inU = q & 1 ? d.u1 > node.u || node.u >= whole.u1 : d.u0 < node.u;
      const bool inV = q & 2 ? d.v1 > node.v || node.v >= whole.v1 : d.v0 < node.v;
      if (inU && inV) node.child[q] = below, has[q] = true;
    }
  }
  // Quadrants outside the outline have no element: a point on its rim belongs to a neighbour.
  int any = 0;
  while (any < 3 && !has[any]) ++any;
  for (int q = 0; q < 4; ++q) {
    if (has[q]) continue;
    const int beside = has[q ^ 1] ? q ^ 1 : has[q ^ 2] ? q ^ 2 : any;
    node.child[q] = node.child[beside];
  }
  nodes_[at] = node;
  return static_cast<std::int32_t>(at);
}

std::uint32_t LeafLocator::at(const Side& side, const Vec3f& p) const {
  const ElementId holder = elements_.sides.at(side);
  if (!holder.valid()) return LeafTable::kNone;
  const std::uint32_t index = planeOf_[holder.index()];
  if (index == LeafTable::kNone) return LeafTable::kNone;
  const Plane& plane = planes_[index];
  std::int32_t n = plane.root;
  if (n < 0) return static_cast<std::uint32_t>(~n);
  Vec2 uv;
  if (plane.flat) {
    const Vec3 d = Vec3(p) - plane.origin;
    uv = {glm::dot(d, plane.dualU), glm::dot(d, plane.dualV)};
  } else {
    uv = parameterAt(scene_[side.primitive].shape, Vec3(p), side.triangle);
  }
  const float u = static_cast<float>(uv.x), v = static_cast<float>(uv.y);
  while (n >= 0) {
    const Node& node = nodes_[static_cast<std::size_t>(n)];
    n = node.child[(u >= node.u ? 1 : 0) + (v >= node.v ? 2 : 0)];
  }
  return static_cast<std::uint32_t>(~n);
}

}  // namespace deltalux::hierarchy
