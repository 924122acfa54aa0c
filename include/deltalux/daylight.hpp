#pragma once
// Sun and sky of a time and place.
//
// The sun stands where the Astronomical Almanac's low-precision formulas and refraction have it, to 0.01 degrees from
// 1950 to 2050. [Michalsky88] The sky is a CIE standard general sky [ISO 15469] or the all-weather sky of two
// irradiances [PSM93], whose luminous efficacies make them light [PIS90]. Below the horizon is ground of one
// reflectance.
//
// East is the scene's +x. Where z is up, north is +y, where y is up, -z, turned by `north`.
#include <deltalux/scene.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace deltalux {

/// A time of the Gregorian calendar, by a clock.
struct CivilTime {
  int year = 2000, month = 1, day = 1;
  double hour = 12;            // [0, 24)
  std::optional<double> zone;  // hours ahead of universal time; not said: the whole hour that suits the longitude

  bool operator==(const CivilTime&) const = default;
};

/// Degrees; north and east are positive.
struct Place {
  double latitude = 0, longitude = 0;

  bool operator==(const Place&) const = default;
};

/// One of the 15 standard skies. How bright is typical of it at the sun's altitude, and with a sun where it is one of 7
/// to 15 [DK02]; where its illuminance is given there is no sun.
struct GeneralSky {
  int type = 1;
  std::optional<double> illuminance;  // on open ground [lux]

  bool operator==(const GeneralSky&) const = default;
};

/// The all-weather sky of measured irradiances [W/m2].
struct AllWeatherSky {
  double directNormal = 0, diffuseHorizontal = 0;

  bool operator==(const AllWeatherSky&) const = default;
};

struct Daylighting {
  std::variant<GeneralSky, AllWeatherSky> sky;
  CivilTime time;
  Place place;
  double north = 0;  // of true north, clockwise from the scene's, seen from above [degrees]
  double groundReflectance = 0.2;

  bool operator==(const Daylighting&) const = default;
};

/// Where the sun is seen [rad]: above the horizon, and clockwise from north.
struct SunSighting {
  double altitude = 0, azimuth = 0;
};
SunSighting sightSun(const CivilTime&, const Place&);

/// Lights of a daylight, for a scene with this up, read by this efficacy. By night both are black.
struct SunAndSky {
  SunLight sun;
  DomeLight sky;
};
SunAndSky sunAndSky(const Daylighting&, const Vec3& up, double luminousEfficacy);

/// Puts sun and sky over a scene that is not solved yet, as its lights "sun" and "sky", in place of all suns, skies and
/// backdrops that it has; returns how many those were.
std::size_t setDaylight(Scene&, const Daylighting&);

// As texts of the command line and of edits have them; nothing where a text does not read so, or says what cannot be.

/// "cie:TYPE", "cie:TYPE,LUX" or "perez:DIRECT_NORMAL,DIFFUSE_HORIZONTAL".
std::optional<std::variant<GeneralSky, AllWeatherSky>> parseSkyModel(std::string_view);
/// "2026-06-21T09:00", with seconds and a zone ("Z", "+02:00") where wanted.
std::optional<CivilTime> parseCivilTime(std::string_view);
/// "LATITUDE,LONGITUDE".
std::optional<Place> parsePlace(std::string_view);
std::string toText(const std::variant<GeneralSky, AllWeatherSky>&);
std::string toText(const CivilTime&);
std::string toText(const Place&);

}  // namespace deltalux
