#include "scene/daylight/sun.hpp"

#include <cmath>
#include <deltalux/math.hpp>

namespace deltalux::scene {

double daysSince2000(int year, int month, int day, double universalHour) {
  // Fliegel & Van Flandern's count of days in the Gregorian calendar.
  const int shift = (14 - month) / 12, y = year + 4800 - shift, m = month + 12 * shift - 3;
  const int julianDay = day + (153 * m + 2) / 5 + 365 * y + y / 4 - y / 100 + y / 400 - 32045;
  return julianDay - 2451545 + (universalHour - 12) / 24;
}

SolarCoordinates solarCoordinates(double days, double universalHour) {
  const double meanLongitude = glm::radians(280.460 + 0.9856474 * days);
  const double anomaly = glm::radians(357.528 + 0.9856003 * days);
  const double longitude =
      meanLongitude + glm::radians(1.915) * std::sin(anomaly) + glm::radians(0.020) * std::sin(2 * anomaly);
  const double obliquity = glm::radians(23.439 - 4e-7 * days);
  return {std::asin(std::sin(obliquity) * std::sin(longitude)),
          std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude)),
          (6.697375 + 0.0657098242 * days + universalHour) * kPi / 12};
}

double refraction(double altitude) {
  const double h = glm::degrees(altitude);
  const double least = -0.56;  // where the sun's centre sets
  if (h < least) return 0;
  return glm::radians(3.51561 * (0.1594 + 0.0196 * h + 0.00002 * h * h) / (1 + 0.505 * h + 0.0845 * h * h));
}

}  // namespace deltalux::scene
