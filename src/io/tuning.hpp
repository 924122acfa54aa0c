#pragma once
// The tuned constants of readers: purpose, unit, normal value, and what breaks.
namespace deltalux::io::tuning {

/// Largest source that is a sun, and no part of the sky [degrees across]. Larger: edges of large skies are sharp lamps.
/// Smaller: low suns in haze are found by chance.
constexpr double kLargestSun = 20;

}  // namespace deltalux::io::tuning
