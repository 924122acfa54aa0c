#pragma once
// A ray in four bytes: what a row remembers of each, so that the few that something moving may touch are found without
// looking at the others. A ray that passes can be touched as far as it goes. One that something blocks stays blocked
// whatever moves but the blocker: only there can it be touched.
#include <bit>

#include "radiosity/direction_code.hpp"

namespace deltalux::radiosity {

struct RayCode {
  /// Blocked: one bit; the end, in lengths of the decoded direction: a float without its sign and lower half; the
  /// direction from the middle of the leaf: y, x. In one word, so that loops over many become vector code.
  std::uint32_t bits = 0;
};

/// No end is decoded as more than this share nearer than it is.
constexpr float kRayCodeError = 0.009f;

inline RayCode rayCode(DirectionCode towards, float end, bool blocked) {
  return {std::uint32_t{blocked} << 31 | (std::bit_cast<std::uint32_t>(end) & 0x7fff0000u) |
          static_cast<std::uint32_t>(static_cast<std::uint8_t>(towards.y)) << 8 | static_cast<std::uint8_t>(towards.x)};
}

/// From the middle of a leaf to `d`, of any length but zero; blocked there or not.
inline RayCode rayCode(const Vec3f& d, bool blocked) {
  const DirectionCode towards = directionCode(d);
  return rayCode(towards, glm::length(d) / glm::length(direction(towards)), blocked);
}

inline bool blocked(RayCode code) { return code.bits >> 31; }

/// How far the ray goes at least.
inline float end(RayCode code) { return std::bit_cast<float>(code.bits & 0x7fff0000u); }

inline DirectionCode towards(RayCode code) {
  return {static_cast<std::int8_t>(code.bits), static_cast<std::int8_t>(code.bits >> 8)};
}

}  // namespace deltalux::radiosity
