#pragma once
// The tuned constants of readers: purpose, unit, normal value, and what breaks.
#include <cstddef>

namespace deltalux::io::tuning {

/// Steps of the polar angle that tables of patterns begin with, 2 degrees, and directions of such a ring. Fewer: narrow
/// peaks are overlooked.
constexpr std::size_t kSteps = 90;
/// Largest source that is a sun, and no part of the sky [degrees across]. Larger: edges of large skies are sharp lamps.
/// Smaller: low suns in haze are found by chance.
constexpr double kLargestSun = 20;

}  // namespace deltalux::io::tuning
