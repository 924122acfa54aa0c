#pragma once
// Where the sun stands. Solar declination and equation of time by the approximations of the IES Lighting Handbook (1984
// Reference Volume, 7), which gensky uses; with a year, by the Astronomical Almanac's low-precision formulas
// [Michalsky88].
#include <deltalux/math.hpp>
#include <optional>

namespace deltalux::io::radiance {

/// Angles in radians; longitudes west of Greenwich are positive, as gensky takes them.
struct Site {
  double latitude = 0.66, longitude = 2.13, meridian = 2.0944;  // Berkeley, Pacific time: gensky's own defaults
};

struct SunTime {
  int month = 6, day = 21;
  double hour = 12;    // of the site's standard meridian, or solar time
  bool solar = false;  // `hour` is local solar time
  std::optional<int> year;
};

struct SunAngles {
  double altitude = 0;  // above the horizon
  double azimuth = 0;   // west of south
};

SunAngles sunAngles(const SunTime&, const Site&);
/// Unit direction to the sun: x east, y north, z up.
Vec3 sunDirection(const SunAngles&);

}  // namespace deltalux::io::radiance
