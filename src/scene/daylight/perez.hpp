#pragma once
// Perez's models of daylight: the sky's radiance from its clearness and brightness [PSM93], and luminous efficacies
// [PIS90]; and what irradiance a sky comes to.
#include <array>
#include <deltalux/light.hpp>

namespace deltalux::scene {

struct SkyCondition {
  double sunZenith = 0;     // [rad]
  double clearness = 1;     // epsilon, 1 (overcast) to 12
  double brightness = 0.1;  // Delta, 0.01 to 0.6
};

/// Sun and sky: across the beam, and on the horizontal.
struct Daylight {
  double directNormal = 0, diffuse = 0;
};

/// Irradiance beyond the atmosphere [W/m2], at the sun's mean distance.
inline constexpr double kSolarConstant = 1367;  // [defined]

/// Irradiance beyond the atmosphere [W/m2] on a day of the year, the first of which is 1. [Spencer71]
double outsideIrradiance(double dayOfYear);
/// Optical air mass of the sun's path. [Kasten66]
double airMass(double sunZenith);
/// epsilon and Delta of irradiances [W/m2], within the models' range; `outside` is the irradiance beyond the
/// atmosphere.
SkyCondition conditionOf(const Daylight&, double sunZenith, double outside);
/// The irradiances of a condition: the inverse.
Daylight daylightOf(const SkyCondition&, double outside);
/// Luminous efficacies [lm/W] of both; `water`: precipitable water in the air [cm].
Daylight efficacies(const SkyCondition&, double water);
/// Coefficients a to e of the radiance distribution.
std::array<double, 5> perezCoefficients(const SkyCondition&);


/// Irradiance [W/m2], of one channel, of the part of a sky that is above the horizontal, by cosine-weighted quadrature.
double horizontalIrradiance(const DomeLight&);

}  // namespace deltalux::scene
