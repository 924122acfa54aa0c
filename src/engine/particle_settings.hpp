#pragma once
#include <algorithm>
#include <deltalux/settings.hpp>

#include "particles/particles.hpp"

namespace deltalux::engine {

/// How many particles a solution asks for: their error falls with the root of their number. Over lines they start at
/// lights alone.
inline particles::ParticleSettings particleSettings(const SolveSettings& s) {
  constexpr double kAtUnitError = 1000, kLeast = 1e5, kMost = 3e6;  // [tuned]
  particles::ParticleSettings settings{s.particles, s.seed};
  if (s.particles == 0)
    settings.count = static_cast<std::uint64_t>(std::clamp(kAtUnitError / (s.error * s.error), kLeast, kMost));
  settings.ofSurfaces = s.method == SolveMethod::Paper;
  return settings;
}

}  // namespace deltalux::engine
