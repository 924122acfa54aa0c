#pragma once
#include <algorithm>
#include <deltalux/settings.hpp>

#include "engine/tuning.hpp"
#include "particles/particles.hpp"

namespace deltalux::engine {

/// More take too much memory: some gigabytes.
inline constexpr double kMostParticles = 1 << 24;  // [limit]

/// How many particles a solution asks for: their error falls with the root of their number. Over lines they start at
/// lights alone.
inline particles::ParticleSettings particleSettings(const SolveSettings& s) {
  particles::ParticleSettings settings{s.particles, s.seed};
  if (s.particles == 0)
    settings.count =
        static_cast<std::uint64_t>(std::min(tuning::kParticlesAtUnitError / (s.error * s.error), kMostParticles));
  settings.ofSurfaces = s.method == SolveMethod::Paper;
  return settings;
}

}  // namespace deltalux::engine
