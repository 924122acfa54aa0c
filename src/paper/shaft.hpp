#pragma once
// Shafts [HW91]: the convex hull of the boxes of two elements, tested against boxes of blockers. Never
// stored: rebuilt from the two boxes on the way down the link tree. [GD01 5]
#include <array>

#include "hierarchy/element.hpp"

namespace deltalux::paper {

class Shaft {
 public:
  Shaft(const hierarchy::ElementGeometry& a, const hierarchy::ElementGeometry& b);

  /// Whether the box has a point in the hull (conservative: never false when it has).
  bool meets(const Vec3f& lower, const Vec3f& upper) const;

 private:
  static constexpr std::size_t kLanes = 16;  // [task]
  using Lanes = std::array<float, kLanes>;

  Vec3f lower_, upper_;
  // Of planes, up to twelve: the hull has n . p <= offset, n outward. What of n is positive, and what is negative; rest
  // lanes have no limit.
  std::array<Lanes, 3> positive_{}, negative_{};
  Lanes offset_;
};

}  // namespace deltalux::paper
