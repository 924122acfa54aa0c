#pragma once
#include <cmath>
#include <deltalux/math.hpp>

#include "base/unit_circle.hpp"

namespace deltalux {

/// A direction about the frame's normal by two numbers in [0,1), with a density in proportion to its cosine.
inline Vec3 cosineDirection(const Frame& frame, double u, double v) {
  return frame.toWorld(Vec3(std::sqrt(u) * onUnitCircle(v), std::sqrt(1 - u)));
}

}  // namespace deltalux
