#pragma once
// Shafts [Haines & Wallace 1991]: the convex hull of the boxes of two elements, tested against boxes of blockers. Never
// stored: rebuilt from the two boxes on the way down the link tree. [GD01 5]
#include <array>

#include "hierarchy/element.hpp"

namespace deltalux {

class Shaft {
 public:
  Shaft(const ElementGeometry& a, const ElementGeometry& b);

  /// Whether the box has a point in the hull (conservative: never false when it has).
  bool meets(const Vec3f& lower, const Vec3f& upper) const;

 private:
  struct Plane {
    Vec3f normal;  // outward
    float offset;  // the hull has normal . p <= offset
  };
  Vec3f lower_, upper_;
  std::array<Plane, 12> planes_;
  int count_ = 0;
};

}  // namespace deltalux
