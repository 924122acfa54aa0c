#include "io/radiance/sun_position.hpp"

#include <array>
#include <cmath>

#include "scene/daylight/sun.hpp"

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

SunState almanacSun(const SunTime& time, const Site& site) {
  const double universalHour = time.hour + site.meridian * 12 / kPi;
  const double days = scene::daysSince2000(*time.year, time.month, time.day, universalHour);
  const scene::SolarCoordinates sun = scene::solarCoordinates(days, universalHour);
  if (time.solar) return {sun.declination, time.hour};
  const double solarTime = std::fmod((sun.siderealTime - site.longitude - sun.rightAscension) * 12 / kPi + 12, 24.0);
  return {sun.declination, solarTime < 0 ? solarTime + 24 : solarTime};
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
