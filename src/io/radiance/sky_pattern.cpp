#include "io/radiance/sky_pattern.hpp"

#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

namespace {

[[noreturn]] void failSky(const RadObject& object, const std::string& message, const std::string& hint = {}) {
  throw inputError(object.where, "brightfunc '" + object.name + "': " + message, hint);
}

/// The canonical form, in the world's directions.
void become(RadObject& object, Type type, std::vector<double> reals) {
  const std::span<const std::string> options = std::span(object.strings).subspan(2);
  std::size_t used = 0;
  const Transform transform = parseTransform(options, used, object.where);
  if (used != options.size()) failSky(object, "'" + options[used] + "' is no transform option");
  RadObject canonical = object;
  canonical.type = type;
  canonical.strings.clear();
  canonical.reals = std::move(reals);
  object = placed(canonical, Placement{transform, false, {}, {}});
}

void recogniseGensky(RadObject& object) {
  const std::vector<double>& a = object.reals;
  const int kind = a.empty() ? 0 : static_cast<int>(a[0]);
  const bool cloudy = kind == 2 || kind == 3;
  if (kind < 1 || kind > 4 || kind != a[0] || a.size() != (cloudy ? 3u : 7u)) {
    throw inputError(object.where, "brightfunc '" + object.name + "': skybr's arguments are not those of gensky",
                     "3 for an overcast (2) or uniform (3) sky, 7 for a clear (1) or intermediate (4) one");
  }
  RadianceSky sky{static_cast<RadianceSky::Kind>(kind), a[1], a[2], 1, Vec3(0, 0, 1)};
  if (!cloudy) {
    sky.normalization = a[3];
    sky.sunDirection = {a[4], a[5], a[6]};
    if (!(sky.normalization > 0) || glm::length(sky.sunDirection) == 0) {
      throw inputError(object.where, "brightfunc '" + object.name + "': normalisation or sun direction is zero");
    }
    sky.sunDirection = glm::normalize(sky.sunDirection);
  }
  become(object, Type::SkyBrightness, skyArguments(sky, Vec3(0, 0, 1)));
}

void recogniseGendaylit(RadObject& object) {
  const std::vector<double>& a = object.reals;
  if (a.size() != 10) {
    failSky(object, "skybright's arguments are not those of gendaylit",
         "diffuse normalisation, ground brightness, five coefficients, sun direction");
  }
  const Vec3 sun(a[7], a[8], a[9]);
  PerezSky sky{a[0], a[1], {a[2], a[3], a[4], a[5], a[6]}, glm::length(sun) > 0 ? glm::normalize(sun) : Vec3(0, 0, 1)};
  become(object, Type::PerezBrightness, skyArguments(sky, Vec3(0, 0, 1)));
}

}  // namespace

void recogniseSky(RadObject& object) {
  if (object.strings.size() < 2) return;
  const std::string &function = object.strings[0], &file = object.strings[1];
  if (function == "skybr" && file.ends_with("skybright.cal")) return recogniseGensky(object);
  if (function == "skybright" && file.ends_with("perezlum.cal")) return recogniseGendaylit(object);
}

std::vector<double> skyArguments(const RadianceSky& sky, const Vec3& up) {
  const Vec3& sun = sky.sunDirection;
  return {
      static_cast<double>(sky.kind), sky.zenith, sky.ground, sky.normalization, sun.x, sun.y, sun.z, up.x, up.y, up.z};
}

std::vector<double> skyArguments(const PerezSky& sky, const Vec3& up) {
  const auto& [a, b, c, d, e] = sky.coefficients;
  const Vec3& sun = sky.sunDirection;
  return {sky.diffuse, sky.ground, a, b, c, d, e, sun.x, sun.y, sun.z, up.x, up.y, up.z};
}

SkyFunction skyOf(const RadObject& object) {
  const std::vector<double>& a = object.reals;
  if (object.type == Type::PerezBrightness)
    return PerezSky{a[0], a[1], {a[2], a[3], a[4], a[5], a[6]}, glm::normalize(Vec3(a[7], a[8], a[9]))};
  const auto kind = static_cast<RadianceSky::Kind>(static_cast<int>(a[0]));
  return RadianceSky{kind, a[1], a[2], a[3], glm::normalize(Vec3(a[4], a[5], a[6]))};
}

Vec3 zenithOf(const RadObject& object) {
  const double* const up = object.reals.data() + object.reals.size() - 3;
  return glm::normalize(Vec3(up[0], up[1], up[2]));
}

}  // namespace deltalux::io::radiance
