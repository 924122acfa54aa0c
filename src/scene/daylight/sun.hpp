#pragma once
// The sun among the stars: low-precision formulas of the Astronomical Almanac. [Michalsky88]

namespace deltalux::scene {

/// Days from noon of 1 January 2000, of the Gregorian calendar, universal time.
double daysSince2000(int year, int month, int day, double universalHour);

/// Angles in radians.
struct SolarCoordinates {
  double declination = 0, rightAscension = 0;
  double siderealTime = 0;  // of Greenwich
};
SolarCoordinates solarCoordinates(double days, double universalHour);

/// By how much the air lifts what stands at an altitude, at sea level [rad]. [Michalsky88]
double refraction(double altitude);

}  // namespace deltalux::scene
