#pragma once
// What lies on a surface. A point that another surface covers takes no light and sends none: no lines start there, and
// the irradiance of its leaf is that of the rest. [lines.md]
#include <span>

#include "base/box_tree.hpp"
#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::lines {

class Cover {
 public:
  /// Both must outlive this.
  Cover(const Scene&, const tracing::RayTracer&);

  /// Whether any other surface comes so near to the leaf that it may lie on it.
  bool mayTouch(const hierarchy::Elements&, hierarchy::ElementId leaf) const;
  /// Whether another surface lies on this one at `p`, with the unit normal of its side: within some roundings of it. Of
  /// two that coincide one is covered, the one that rays do not meet.
  bool covers(const Vec3f& p, const Vec3f& normal, PrimitiveId own) const;

 private:
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  BoxTree boxes_;  // by primitive
};

/// By element of the input level: whether walks from it find no light, in a hollow too small to be a room. What lies
/// there takes no part, and covers what it stands on. [lines.md]
std::vector<char> enclosedSides(const hierarchy::Elements&, const class LineTracer&, std::uint64_t& rays);

}  // namespace deltalux::lines
