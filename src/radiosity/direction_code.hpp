#pragma once
// Directions in two bytes: a grid of 256 x 256 on the octahedral map. What a row remembers of its rays, so that the few
// that may go where something has moved are found without looking at the others.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deltalux/math.hpp>

namespace deltalux::radiosity {

struct DirectionCode {
  std::int8_t x = 0, y = 0;

  friend bool operator==(DirectionCode, DirectionCode) = default;
};

/// No decoded direction is further from the coded one [radians].
constexpr float kDirectionCodeError = 0.018f;

/// Of a direction of any length but zero.
DirectionCode directionCode(const Vec3f&);

/// Not of unit length. Here, so that loops over many become vector code.
inline Vec3f direction(DirectionCode code) {
  const float x = static_cast<float>(code.x) * (1.0f / 127.0f), y = static_cast<float>(code.y) * (1.0f / 127.0f);
  const float z = 1.0f - std::abs(x) - std::abs(y), below = std::max(0.0f, -z);
  return {x < 0 ? x + below : x - below, y < 0 ? y + below : y - below, z};
}

}  // namespace deltalux::radiosity
