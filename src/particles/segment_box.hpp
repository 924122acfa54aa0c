#pragma once
// Whether a segment meets a box: the separating axes of a box and a line [Ericson05 5.3.3]. Generous by some roundings.
#include <algorithm>
#include <deltalux/math.hpp>

namespace deltalux::particles {

class SegmentBox {
 public:
  /// `margin` on every side.
  SegmentBox(const Box& box, double margin)
      : center_(box.center()),
        half_(Vec3f(0.5 * box.extent() + margin)),
        lower_(center_ - half_),
        upper_(center_ + half_) {}

  bool meets(const Vec3f& a, const Vec3f& b) const {
    const Vec3f low = glm::min(a, b), high = glm::max(a, b);
    if (low.x > upper_.x || high.x < lower_.x || low.y > upper_.y || high.y < lower_.y || low.z > upper_.z ||
        high.z < lower_.z)
      return false;
    constexpr float kRounding = 4e-7f;  // [rounding]
    const Vec3f d = 0.5f * (b - a), m = glm::abs(glm::cross(0.5f * (a + b) - center_, d)), e = glm::abs(d);
    const float rounding = kRounding * glm::dot(e, e) + kRounding * glm::length(a - center_) * glm::length(e);
    return m.x <= half_.y * e.z + half_.z * e.y + rounding && m.y <= half_.x * e.z + half_.z * e.x + rounding &&
           m.z <= half_.x * e.y + half_.y * e.x + rounding;
  }

  bool holds(const Vec3f& p) const {
    return glm::all(glm::lessThanEqual(lower_, p)) && glm::all(glm::lessThanEqual(p, upper_));
  }

 private:
  Vec3f center_, half_, lower_, upper_;
};

}  // namespace deltalux::particles
