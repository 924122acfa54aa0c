#include <algorithm>
#include <cmath>
#include <deltalux/daylight.hpp>

#include "base/check.hpp"
#include "scene/daylight/perez.hpp"
#include "scene/daylight/sun.hpp"

namespace deltalux {

namespace {

// Typical of the types 1 to 15 [DK02, table 2]: diffuse horizontal illuminance over that beyond the atmosphere, and the
// turbidity by which the sun shines through the last nine.
constexpr std::array<double, 15> kDiffuseShare{0.10, 0.18, 0.15, 0.22, 0.20, 0.38, 0.42, 0.41,
                                               0.40, 0.36, 0.23, 0.10, 0.28, 0.28, 0.30};     // [defined]
constexpr std::array<double, 9> kTurbidity{12.0, 10.0, 12.0, 10.0, 4.0, 2.5, 4.5, 5.0, 4.0};  // [defined]
constexpr int kFirstSunny = 7;                                                                // [defined]
constexpr double kOutsideIlluminance = 133.8e3;  // across the sun's beam, beyond the atmosphere [lux] [defined]
constexpr double kWater = 2;                     // precipitable, in the air [cm]; gendaylit's [defined]

double universalHour(const CivilTime& time, const Place& place) {
  return time.hour - time.zone.value_or(std::round(place.longitude / 15));
}

double dayOfYear(const CivilTime& time) {
  return scene::daysSince2000(time.year, time.month, time.day, 12) - scene::daysSince2000(time.year, 1, 1, 12) + 1;
}

/// Of the sun's beam and the sky on the ground, in light: what a scene's radiance is of [W/m2].
struct Shares {
  double beam = 0, diffuse = 0;
};

/// Turbid air dims the beam by exp(-a m T). [DK02 (9)]
Shares generalShares(const GeneralSky& model, double altitude, double outside, double efficacy) {
  if (model.illuminance) return {0, *model.illuminance / efficacy};
  if (altitude <= 0) return {};
  const auto type = static_cast<std::size_t>(model.type);
  const double beyond = kOutsideIlluminance * outside / scene::kSolarConstant / efficacy;
  Shares shares{0, kDiffuseShare[type - 1] * beyond * std::sin(altitude)};
  if (model.type < kFirstSunny) return shares;
  const double m = scene::airMass(kPi / 2 - altitude);
  shares.beam = beyond * std::exp(-m * kTurbidity[type - kFirstSunny] / (9.9 + 0.043 * m));
  return shares;
}

/// A sky of the distribution's shape over ground, as bright as it has to be.
DomeLight skyOver(const Vec3& up, const Shares& shares, double sineOfAltitude, double groundReflectance, auto shape) {
  DomeLight dome;
  dome.axis = dome.up = up;
  dome.halfAngle = kPi;
  double& zenith = [&]() -> double& {
    if constexpr (requires { shape.zenith; })
      return shape.zenith;
    else
      return shape.diffuse;
  }();
  zenith = 1, shape.ground = 0;
  dome.distribution = shape;
  const double relative = scene::horizontalIrradiance(dome);
  zenith = relative > 0 ? shares.diffuse / relative : 0;
  shape.ground = groundReflectance * (shares.diffuse + shares.beam * std::max(0.0, sineOfAltitude)) / kPi;
  dome.distribution = shape;
  return dome;
}

/// Unit direction to the sun.
Vec3 towards(const SunSighting& sun, const Vec3& up, double north) {
  const Vec3 hint = std::abs(up.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 east = glm::normalize(hint - glm::dot(hint, up) * up), straight = glm::cross(up, east);
  const double azimuth = sun.azimuth + glm::radians(north);
  return glm::normalize(std::sin(sun.altitude) * up +
                        std::cos(sun.altitude) * (std::cos(azimuth) * straight + std::sin(azimuth) * east));
}

}  // namespace

SunSighting sightSun(const CivilTime& time, const Place& place) {
  const double hour = universalHour(time, place);
  const scene::SolarCoordinates sun =
      scene::solarCoordinates(scene::daysSince2000(time.year, time.month, time.day, hour), hour);
  const double hourAngle = sun.siderealTime + glm::radians(place.longitude) - sun.rightAscension;
  const double latitude = glm::radians(place.latitude);
  const double sinD = std::sin(sun.declination), cosD = std::cos(sun.declination);
  const double sinL = std::sin(latitude), cosL = std::cos(latitude);
  const double altitude = std::asin(std::clamp(sinL * sinD + cosL * cosD * std::cos(hourAngle), -1.0, 1.0));
  const double azimuth = std::atan2(-cosD * std::sin(hourAngle), cosL * sinD - sinL * cosD * std::cos(hourAngle));
  return {altitude + scene::refraction(altitude), azimuth < 0 ? azimuth + 2 * kPi : azimuth};
}

SunAndSky sunAndSky(const Daylighting& daylight, const Vec3& up, double luminousEfficacy) {
  const SunSighting sighting = sightSun(daylight.time, daylight.place);
  const Vec3 zenith = glm::normalize(up), sun = towards(sighting, zenith, daylight.north);
  const double outside = scene::outsideIrradiance(dayOfYear(daylight.time)), sine = glm::dot(sun, zenith);
  SunAndSky result;
  result.sun.direction = sun;
  Shares shares;
  if (const auto* general = std::get_if<GeneralSky>(&daylight.sky)) {
    DELTALUX_CHECK(general->type >= 1 && general->type <= 15, "CIE sky types are 1 to 15");
    shares = generalShares(*general, sighting.altitude, outside, luminousEfficacy);
    result.sky = skyOver(zenith, shares, sine, daylight.groundReflectance, CieSky{general->type, 1, 0, sun});
  } else {
    const AllWeatherSky& measured = std::get<AllWeatherSky>(daylight.sky);
    // At dusk, by the sun on the horizon.
    const double sunZenith = std::min(kPi / 2 - sighting.altitude, kPi / 2);
    const scene::Daylight light{sighting.altitude > 0 ? measured.directNormal : 0, measured.diffuseHorizontal};
    const scene::SkyCondition condition = scene::conditionOf(light, sunZenith, outside);
    const scene::Daylight K = scene::efficacies(condition, kWater);
    shares = {light.directNormal * K.directNormal / luminousEfficacy, light.diffuse * K.diffuse / luminousEfficacy};
    PerezSky sky;
    sky.coefficients = scene::perezCoefficients(condition), sky.sunDirection = sun;
    result.sky = skyOver(zenith, shares, sine, daylight.groundReflectance, sky);
  }
  result.sun.radiance = Rgb(static_cast<float>(shares.beam / solidAngle(result.sun)));
  return result;
}

std::size_t setDaylight(Scene& scene, const Daylighting& daylight) {
  DELTALUX_CHECK(scene.switchedOff.empty(), "a scene that was edited takes its daylight by an edit");
  const auto infinite = [](const Light& light) {
    return std::holds_alternative<SunLight>(light.emitter) || std::holds_alternative<DomeLight>(light.emitter);
  };
  const std::size_t gone = std::erase_if(scene.lights, infinite) + scene.backdrops.size();
  scene.backdrops.clear();
  SunAndSky lights = sunAndSky(daylight, scene.up, scene.luminousEfficacy);
  scene.lights.push_back({"sun", std::move(lights.sun), Rgb(1.0f)});
  scene.lights.push_back({"sky", std::move(lights.sky), Rgb(1.0f)});
  return gone;
}

}  // namespace deltalux
