#include "io/radiance/sun_position.hpp"

#include <array>
#include <cmath>

namespace deltalux::io::radiance {

namespace {

int dayOfYear(int month, int day) {
  constexpr std::array<int, 12> kBefore{0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};  // [defined]
  return kBefore[static_cast<std::size_t>(month - 1)] + day;
}

struct SunState {
  double declination = 0;
  double solarTime = 0;  // hours, 12 when the sun is in the south
};

SunState handbookSun(const SunTime& time, const Site& site) {
  const double day = dayOfYear(time.month, time.day);
  const double declination = 0.4093 * std::sin(2 * kPi / 368 * (day - 81));
  const double equationOfTime =
      0.170 * std::sin(4 * kPi / 373 * (day - 80)) - 0.129 * std::sin(2 * kPi / 355 * (day - 8));
  const double zoneShift = (site.meridian - site.longitude) * 12 / kPi;
  return {declination, time.solar ? time.hour : time.hour + equationOfTime + zoneShift};
}

/// Days from noon of 1 January 2000, universal time.
double daysSince2000(int year, int month, int day, double universalHour) {
  // Fliegel & Van Flandern's count of days in the Gregorian calendar.
  const int shift = (14 - month) / 12, y = year + 4800 - shift, m = month + 12 * shift - 3;
  const int julianDay = day + (153 * m + 2) / 5 + 365 * y + y / 4 - y / 100 + y / 400 - 32045;
  return julianDay - 2451545 + (universalHour - 12) / 24;
}

SunState almanacSun(const SunTime& time, const Site& site) {
  const double universalHour = time.hour + site.meridian * 12 / kPi;
  const double n = daysSince2000(*time.year, time.month, time.day, universalHour);
  const double meanLongitude = glm::radians(280.460 + 0.9856474 * n), anomaly = glm::radians(357.528 + 0.9856003 * n);
  const double longitude =
      meanLongitude + glm::radians(1.915) * std::sin(anomaly) + glm::radians(0.020) * std::sin(2 * anomaly);
  const double obliquity = glm::radians(23.439 - 4e-7 * n);
  const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
  if (time.solar) return {declination, time.hour};
  const double rightAscension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
  const double siderealHour = 6.697375 + 0.0657098242 * n + universalHour - site.longitude * 12 / kPi;
  const double solarTime = std::fmod(siderealHour - rightAscension * 12 / kPi + 12, 24.0);
  return {declination, solarTime < 0 ? solarTime + 24 : solarTime};
}

}  // namespace

SunAngles sunAngles(const SunTime& time, const Site& site) {
  const SunState sun = time.year ? almanacSun(time, site) : handbookSun(time, site);
  const double hourAngle = sun.solarTime * kPi / 12;  // from midnight
  const double sinD = std::sin(sun.declination), cosD = std::cos(sun.declination);
  const double sinL = std::sin(site.latitude), cosL = std::cos(site.latitude);
  return {std::asin(sinL * sinD - cosL * cosD * std::cos(hourAngle)),
          -std::atan2(cosD * std::sin(hourAngle), -cosL * sinD - sinL * cosD * std::cos(hourAngle))};
}

Vec3 sunDirection(const SunAngles& angles) {
  return {-std::sin(angles.azimuth) * std::cos(angles.altitude), -std::cos(angles.azimuth) * std::cos(angles.altitude),
          std::sin(angles.altitude)};
}

}  // namespace deltalux::io::radiance
