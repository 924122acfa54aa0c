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

  /// The other surfaces about a leaf, by primitive; none where nothing comes so near that it may lie on it.
  using About = std::vector<std::uint32_t>;
  About about(const hierarchy::Elements&, hierarchy::ElementId leaf) const;
  /// Whether one of them lies on surface `own` at `p`, with the unit normal of its side: within some roundings of it.
  /// Of two that coincide one is covered, the one that rays do not meet. Adds the ray that tells, where one is needed.
  template <class Rays>
  bool covers(const Vec3f& p, const Vec3f& normal, PrimitiveId own, const About& about, Rays& rays) const {
    return mayCover(p, about) && (++rays, isCovered(p, normal, own));
  }

 private:
  bool mayCover(const Vec3f& p, const About&) const;
  bool isCovered(const Vec3f& p, const Vec3f& normal, PrimitiveId own) const;

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  std::vector<BoxF> boxes_;  // by primitive
  BoxTree tree_;             // over them
};

}  // namespace deltalux::lines
