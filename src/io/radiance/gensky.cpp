#include <array>
#include <cmath>
#include <string_view>

#include "io/radiance/generators.hpp"
#include "io/radiance/object_maker.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "io/radiance/sky_time.hpp"

namespace deltalux::io::radiance {

namespace {

using Kind = RadianceSky::Kind;

// Luminous efficacies by which gensky turns photometric sky and sun into radiometric [lm/W].
constexpr double kSkyEfficacy = 203, kSunEfficacy = 208;  // [defined]
constexpr double kSunSolidAngle = 6e-5;                   // [sr], of the 0.5 degree disc [defined]

/// A brightness that is given as radiance, given as horizontal irradiance, or left to be computed.
struct Brightness {
  enum class Given { No, Radiance, Irradiance } given = Given::No;
  double value = 0;
};

struct SkyRequest {
  SunAngles sun;
  Kind kind = Kind::Clear;
  bool withSun = true;
  double turbidity = 2.45;  // Linke factor
  double groundReflectance = 0.2;
  Brightness zenith, solar;

  bool cloudy() const { return kind == Kind::Overcast || kind == Kind::Uniform; }
};

/// Horizontal irradiance of a clear or intermediate sky, relative to its normalised zenith: gensky's polynomials in
/// altitude.
double skyIntegral(Kind kind, double altitude) {
  constexpr std::array<double, 5> kClear{2.766521, 0.547665, -0.369832, 0.009237, 0.059229};  // [defined]
  constexpr std::array<double, 5> kIntermediate{3.5556, -2.7152, -1.3081, 1.0660, 0.60227};   // [defined]
  const auto& coefficients = kind == Kind::Intermediate ? kIntermediate : kClear;
  const double x = (altitude - kPi / 4) / (kPi / 4);
  double sum = 0;
  for (std::size_t i = coefficients.size(); i-- > 0;) sum = sum * x + coefficients[i];
  return sum;
}

/// The distribution's value at the zenith before scaling: F2 of gensky's output.
double zenithValue(Kind kind, double altitude) {
  const double distance = kPi / 2 - altitude;
  if (kind == Kind::Clear) {
    return 0.274 * (0.91 + 10 * std::exp(-3 * distance) + 0.45 * std::sin(altitude) * std::sin(altitude));
  }
  return (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * altitude)) * std::exp(-distance * (0.4441 + 1.48 * altitude));
}

double computedZenith(const SkyRequest& request) {
  const double overcast = 8.6 * std::sin(request.sun.altitude) + 0.123;  // [kcd/m2]
  const double clear = (1.376 * request.turbidity - 1.81) * std::tan(request.sun.altitude) + 0.38;
  const double zenith = request.cloudy()                     ? overcast
                        : request.kind == Kind::Intermediate ? 0.5 * (overcast + clear)
                                                             : clear;
  return std::max(0.0, zenith) * 1000 / kSkyEfficacy;
}

double solarRadiance(const SkyRequest& request) {
  const double sine = std::sin(request.sun.altitude);
  if (request.solar.given == Brightness::Given::Radiance) return request.solar.value;
  if (request.solar.given == Brightness::Given::Irradiance) return request.solar.value / (5.98e-5 * sine);
  const double clear = 1.5e9 / kSunEfficacy * (1.147 - 0.147 / std::max(sine, 0.16));
  return request.kind == Kind::Intermediate ? 0.15 * clear : clear;
}

std::vector<RadObject> makeSky(ObjectMaker& maker, const SkyRequest& request) {
  const Vec3 sun = sunDirection(request.sun);
  RadianceSky sky{request.kind, 0, 0, 1, sun};
  double horizontal = 1;  // horizontal irradiance of the sky over pi times its zenith radiance
  if (request.kind == Kind::Overcast) horizontal = 7.0 / 9;
  if (!request.cloudy()) {
    sky.normalization = zenithValue(request.kind, request.sun.altitude);
    horizontal = skyIntegral(request.kind, request.sun.altitude) / sky.normalization / kPi;
  }
  switch (request.zenith.given) {
    case Brightness::Given::No:
      sky.zenith = computedZenith(request);
      break;
    case Brightness::Given::Radiance:
      sky.zenith = request.zenith.value;
      break;
    case Brightness::Given::Irradiance:
      sky.zenith = request.zenith.value / (horizontal * kPi);
      break;
  }
  double level = sky.zenith * horizontal;
  const bool shines =
      !request.cloudy() && sun.z > 0 && (request.solar.given == Brightness::Given::No || request.solar.value > 0);
  if (shines) {
    const double solar = solarRadiance(request);
    level += kSunSolidAngle / kPi * solar * sun.z;
    if (request.withSun) {
      maker.addNamed(Type::Light, "solar", {solar, solar, solar}).modifier = "void";
      maker.addNamed(Type::Source, "sun", {sun.x, sun.y, sun.z, 0.5}).modifier = "solar";
    }
  }
  sky.ground = level * request.groundReflectance;
  maker.addNamed(Type::SkyBrightness, "skyfunc", skyArguments(sky, Vec3(0, 0, 1))).modifier = "void";
  return maker.take();
}

void readSkyOption(ObjectMaker& maker, const std::string& option, SkyRequest& request) {
  const auto brightness = [&] {
    const auto given = option == "-B" || option == "-R" ? Brightness::Given::Irradiance : Brightness::Given::Radiance;
    const double value = maker.number(option.c_str());
    if (!(value >= 0)) maker.fail(option + " is below zero");
    return Brightness{given, value};
  };
  const bool plus = option[0] == '+';
  const std::string_view letter = std::string_view(option).substr(1);
  if (letter == "s" || letter == "i") {
    request.kind = letter == "s" ? Kind::Clear : Kind::Intermediate;
    request.withSun = plus;
  } else if (letter == "c" || letter == "u") {
    request.kind = letter == "c" ? Kind::Overcast : Kind::Uniform;
  } else if (option == "-b" || option == "-B") {
    request.zenith = brightness();
  } else if (option == "-r" || option == "-R") {
    request.solar = brightness();
  } else if (option == "-t") {
    request.turbidity = maker.number("-t");
  } else if (option == "-g") {
    request.groundReflectance = maker.number("-g");
  } else {
    maker.fail("gensky has no option '" + option + "'");
  }
}

}  // namespace

std::vector<RadObject> gensky(const GeneratorInput& input) {
  ObjectMaker maker(input,
                    "gensky {month day hour | -ang altitude azimuth} [+s|-s|-c|-u|+i|-i] [-a latitude] [-o longitude] "
                    "[-m meridian] [-t turbidity] [-g reflectance] [-b|-B zenith] [-r|-R solar] [-y year]");
  SkyRequest request;
  SkyTime when = readSkyTime(maker);
  while (!maker.done()) {
    const std::string option = readOption(maker);
    if (!readSiteOption(maker, option, when)) readSkyOption(maker, option, request);
  }
  request.sun = sunAngles(when);
  // The distributions have no normalisation with the sun at the zenith; gensky stops at 87 degrees as well.
  if (!request.cloudy()) request.sun.altitude = std::min(request.sun.altitude, glm::radians(87.0));
  return makeSky(maker, request);
}

}  // namespace deltalux::io::radiance
