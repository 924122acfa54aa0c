#pragma once
// The tuned constants of scenes: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::scene::tuning {

/// Octaves of a light's scale that count as one where samples are decided. Fewer: dimming suns and skies, or
/// brightening lamps, asks for samples more often. More: lamps at dusk are measured by the day, and those made brighter
/// have too few samples.
constexpr int kNominalOctaves = 4;
/// Triangles of an emitter that is sampled by solid angle: of more, one is chosen by area. Fewer: noise near lamps of
/// many faces. More: time for each.
constexpr std::size_t kMostBySolidAngle = 8;

}  // namespace deltalux::scene::tuning
