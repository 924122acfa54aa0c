#pragma once
// Where a line runs, in four bytes: its direction in two, and how far it is followed, in steps of a 32nd, rounded up.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <deltalux/math.hpp>

namespace deltalux::lines {

struct LineCode {
  std::int8_t x = 0, y = 0;
  std::uint16_t reach = 0;
};

/// In place of an infinite length.
inline constexpr float kEndless = 3e38f;  // [sentinel]

/// The upper half of a float above `t`: seven bits after the point, so at most a 64th too far.
inline std::uint16_t reachCode(float t) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::isfinite(t) ? t : kEndless);
  return static_cast<std::uint16_t>((bits + 0xffffu) >> 16);
}

/// Of a line into unit direction `w`, followed as far as `t`. Octahedral map. [MSS10]
inline LineCode lineCode(const Vec3f& w, float t) {
  const float sum = std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
  float x = w.x / sum, y = w.y / sum;
  if (w.z < 0) {
    const float u = x;
    x = std::copysign(1 - std::abs(y), x), y = std::copysign(1 - std::abs(u), y);
  }
  return {static_cast<std::int8_t>(std::lround(127 * x)), static_cast<std::int8_t>(std::lround(127 * y)), reachCode(t)};
}

/// No less than the length that was coded.
inline float lengthOf(LineCode code) { return std::bit_cast<float>(static_cast<std::uint32_t>(code.reach) << 16); }

/// Angle between a direction and its code, at most [radians].
inline constexpr float kDirectionError = 0.02f;  // [layout]

/// Not of unit length; within a degree of the coded one.
inline Vec3f direction(LineCode code) {
  const float x = static_cast<float>(code.x) / 127.0f, y = static_cast<float>(code.y) / 127.0f;
  const float z = 1.0f - std::abs(x) - std::abs(y), below = std::max(0.0f, -z);
  return {x < 0 ? x + below : x - below, y < 0 ? y + below : y - below, z};
}

}  // namespace deltalux::lines
