#pragma once
#include <deltalux/math.hpp>

namespace deltalux::io {

/// The axis, or its opposite, that is nearest to a direction: what is up, where only a camera says so.
inline Vec3 nearestAxis(const Vec3& direction) {
  const Vec3 size = glm::abs(direction);
  const int most = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
  Vec3 axis(0);
  axis[most] = direction[most] < 0 ? -1 : 1;
  return axis;
}

}  // namespace deltalux::io
