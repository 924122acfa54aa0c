#pragma once
#include <algorithm>
#include <deltalux/settings.hpp>

namespace deltalux::engine {

/// How many particles a solution asks for: their error falls with the root of their number.
inline std::uint64_t particleCount(const SolveSettings& s) {
  constexpr double kAtUnitError = 1000, kLeast = 1e5, kMost = 3e6;
  return s.particles > 0 ? s.particles
                         : static_cast<std::uint64_t>(std::clamp(kAtUnitError / (s.error * s.error), kLeast, kMost));
}

}  // namespace deltalux::engine
