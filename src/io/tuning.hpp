#pragma once
// The tuned constants of readers: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::io::tuning {

/// Places along each parameter of a surface, and rings of directions, by which a pattern of light is looked at. Fewer:
/// a mean that is off, or what varies taken for constant. More: time at loading, in the square.
constexpr int kPlaces = 16;
/// Steps of the polar angle that tables of patterns begin with, 2 degrees, and directions of such a ring. Fewer: narrow
/// peaks are overlooked.
constexpr std::size_t kSteps = 90;
/// Rounds in which efficacy and irradiance of a sky fit each other. Fewer: the sky's brightness is off by percents.
constexpr int kEfficacyRounds = 8;
/// Largest source that is a sun, and no part of the sky [degrees across]. Larger: edges of large skies are sharp lamps.
/// Smaller: low suns in haze are found by chance.
constexpr double kLargestSun = 20;

}  // namespace deltalux::io::tuning
