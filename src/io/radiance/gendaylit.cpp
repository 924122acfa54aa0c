#include <cmath>
#include <string>
#include <utility>

#include "io/radiance/generators.hpp"
#include "io/radiance/object_maker.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "io/radiance/sky_time.hpp"
#include "scene/daylight/perez.hpp"

namespace deltalux::io::radiance {

namespace {

using scene::conditionOf;
using scene::Daylight;
using scene::daylightOf;
using scene::efficacies;
using scene::SkyCondition;

constexpr double kSunHalfAngle = 0.2665;  // degrees, as gendaylit takes it [defined]

struct DaylightRequest {
  enum class Given { Nothing, Condition, Irradiance, HorizontalIrradiance, Illuminance, Global };
  enum class Output { Visible = 0, Solar = 1, Luminance = 2 };
  Given given = Given::Nothing;
  double first = 0, second = 0;  // of what is given: clearness and brightness, or sun and sky
  Output output = Output::Visible;
  bool withSun = true;
  double groundReflectance = 0.2;
  double water = 2;  // precipitable, in the air [cm]
};

/// Irradiance beyond the atmosphere on that day.
double outsideOf(const SkyTime& when) {
  if (when.angles) return scene::kSolarConstant;
  constexpr std::array<int, 12> kBefore{0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};  // [defined]
  return scene::outsideIrradiance(kBefore[static_cast<std::size_t>(when.time.month - 1)] + when.time.day);
}

/// Sun and sky of global horizontal irradiance. [EKD82]
Daylight erbs(double global, double outside, double sineOfAltitude) {
  const double most = outside * sineOfAltitude;
  const double k = std::min(global / most, 0.999);
  double share = 0.165;
  if (k <= 0.22)
    share = 1 - 0.09 * k;
  else if (k <= 0.8)
    share = 0.9511 + k * (-0.1604 + k * (4.388 + k * (-16.638 + k * 12.336)));
  const double diffuse = share * k * most;
  return {(k * most - diffuse) / sineOfAltitude, diffuse};
}

/// Irradiances whose illuminances these are: efficacies depend on the irradiances in turn.
Daylight irradianceOf(const Daylight& illuminance, double sunZenith, double outside, double water) {
  constexpr double kFirstGuess = 93;  // [lm/W], of a sun and sky about [defined]
  Daylight result{illuminance.directNormal / kFirstGuess, illuminance.diffuse / kFirstGuess};
  constexpr int kMost = 64;  // rounds: they come to rest within ten [limit]
  for (int i = 0; i < kMost; ++i) {
    const Daylight K = efficacies(conditionOf(result, sunZenith, outside), water);
    const Daylight before = std::exchange(
        result, {K.directNormal > 0 ? illuminance.directNormal / K.directNormal : 0, illuminance.diffuse / K.diffuse});
    if (result.directNormal == before.directNormal && result.diffuse == before.diffuse) break;
  }
  return result;
}

void readOptionOf(ObjectMaker& maker, const std::string& option, DaylightRequest& request) {
  using Given = DaylightRequest::Given;
  const auto values = [&](Given given, bool two = true) {
    request.given = given;
    request.first = maker.number(option.c_str()), request.second = two ? maker.number(option.c_str()) : 0;
    if (request.first < 0 || request.second < 0) maker.fail(option + " is below zero");
  };
  if (option == "-P") {
    values(Given::Condition);
  } else if (option == "-W") {
    values(Given::Irradiance);
  } else if (option == "-G") {
    values(Given::HorizontalIrradiance);
  } else if (option == "-L") {
    values(Given::Illuminance);
  } else if (option == "-E") {
    values(Given::Global, false);
  } else if (option == "-O") {
    const long output = maker.integer("-O");
    if (output < 0 || output > 2) maker.fail("-O is 0, 1 or 2");
    request.output = static_cast<DaylightRequest::Output>(output);
  } else if (option == "-s" || option == "+s") {
    request.withSun = option[0] == '+';
  } else if (option == "-c") {
    request.withSun = false;
  } else if (option == "-g") {
    request.groundReflectance = maker.number("-g");
  } else if (option == "-d") {
    request.water = std::exp(0.07 * maker.number("-d") - 0.075);  // of the dew point [PIS90 (3)]
  } else if (option != "-w") {                                    // warnings, of which there are none
    maker.fail("gendaylit has no option '" + option.substr(0, 20) + "' here");
  }
}

/// What the request amounts to in the unit of the output, and the sky's condition.
Daylight requested(const DaylightRequest& request, double sunZenith, double outside, SkyCondition& condition) {
  using Given = DaylightRequest::Given;
  Daylight light{request.first, request.second};
  if (request.given == Given::Illuminance) {
    light = irradianceOf(light, sunZenith, outside, request.water);
  } else if (request.given == Given::HorizontalIrradiance) {
    light.directNormal /= std::cos(sunZenith);
  } else if (request.given == Given::Global) {
    light = erbs(request.first, outside, std::cos(sunZenith));
  } else if (request.given == Given::Condition) {
    light =
        daylightOf({sunZenith, std::clamp(request.first, 1.0, 12.01), std::clamp(request.second, 0.01, 0.6)}, outside);
  }
  condition = conditionOf(light, sunZenith, outside);
  if (request.output == DaylightRequest::Output::Solar) return light;
  if (request.given == Given::Illuminance) {
    light = {request.first, request.second};
  } else {
    const Daylight K = efficacies(condition, request.water);
    light = {light.directNormal * K.directNormal, light.diffuse * K.diffuse};
  }
  if (request.output == DaylightRequest::Output::Luminance) return light;
  return {light.directNormal / kLuminousEfficacy, light.diffuse / kLuminousEfficacy};
}

}  // namespace

std::vector<RadObject> gendaylit(const GeneratorInput& input) {
  ObjectMaker maker(input,
                    "gendaylit {month day hour | -ang altitude azimuth} {-P clearness brightness | -W direct diffuse | "
                    "-G direct diffuse | -L direct diffuse | -E global} [-s|+s|-c] [-g reflectance] [-O 0|1|2] "
                    "[-d dewpoint] [-a latitude] [-o longitude] [-m meridian] [-y year] [-w]");
  DaylightRequest request;
  SkyTime when = readSkyTime(maker);
  while (!maker.done()) {
    const std::string option = readOption(maker);
    if (!readSiteOption(maker, option, when)) readOptionOf(maker, option, request);
  }
  if (request.given == DaylightRequest::Given::Nothing) maker.fail("it is not told how clear and bright the sky is");
  SunAngles angles = sunAngles(when);
  angles.altitude = std::min(angles.altitude, glm::radians(87.0));
  const Vec3 sun = sunDirection(angles);
  PerezSky sky{0, 0, {0, 0, 0, 0, 0}, sun};
  if (sun.z > 0) {
    SkyCondition condition;
    const Daylight light = requested(request, std::acos(sun.z), outsideOf(when), condition);
    sky.coefficients = scene::perezCoefficients(condition);
    sky.diffuse = 1;
    DomeLight dome;
    dome.distribution = sky;
    const double relative = scene::horizontalIrradiance(dome);
    sky.diffuse = relative > 0 ? light.diffuse / relative : 0;
    const bool shines = request.withSun && light.directNormal > 0;
    sky.ground = request.groundReflectance * (light.diffuse + (request.withSun ? light.directNormal * sun.z : 0)) / kPi;
    if (shines) {
      const double L = light.directNormal / solidAngle(SunLight{sun, glm::radians(kSunHalfAngle), Rgb(1.0f)});
      maker.addNamed(Type::Light, "solar", {L, L, L}).modifier = "void";
      maker.addNamed(Type::Source, "sun", {sun.x, sun.y, sun.z, 2 * kSunHalfAngle}).modifier = "solar";
    }
  }
  maker.addNamed(Type::PerezBrightness, "skyfunc", skyArguments(sky, Vec3(0, 0, 1))).modifier = "void";
  return maker.take();
}

}  // namespace deltalux::io::radiance
