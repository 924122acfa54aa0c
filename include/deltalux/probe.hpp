#pragma once
// Light meters: where irradiance is asked for, and what was found there.
#include <cstdint>
#include <deltalux/math.hpp>

namespace deltalux {

/// Irradiance is measured on the side the normal points to.
struct ProbePoint {
  Vec3 position{0};
  Vec3 normal{0, 0, 1};  // unit
};

struct ProbeResult {
  glm::dvec3 irradiance{0};     // E [W/m2]
  glm::dvec3 standardError{0};  // of E, per channel [W/m2]; 0 where the method has none to give
  std::uint64_t samples = 0;    // paths behind the value
};

}  // namespace deltalux
