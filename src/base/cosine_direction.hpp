#pragma once
#include <cmath>
#include <deltalux/math.hpp>

namespace deltalux {

/// A direction about the frame's normal by two numbers in [0,1), with a density in proportion to its cosine.
inline Vec3 cosineDirection(const Frame& frame, double u, double v) {
  const double r = std::sqrt(u), phi = 2 * kPi * v;
  return frame.toWorld({r * std::cos(phi), r * std::sin(phi), std::sqrt(1 - u)});
}

}  // namespace deltalux
