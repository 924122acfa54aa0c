#pragma once
// The tuned constants of scenes: purpose, unit, normal value, and what breaks.

namespace deltalux::scene::tuning {

/// Octaves of a light's scale that count as one where samples are decided. Fewer: dimming suns and skies, or
/// brightening lamps, asks for samples more often. More: lamps at dusk are measured by the day, and those made brighter
/// have too few samples.
constexpr int kNominalOctaves = 4;

}  // namespace deltalux::scene::tuning
