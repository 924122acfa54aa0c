#include "io/radiance/sky_pattern.hpp"

#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

void recogniseSky(RadObject& object) {
  if (object.strings.size() < 2 || object.strings[0] != "skybr" || !object.strings[1].ends_with("skybright.cal"))
    return;
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
  const std::span<const std::string> options = std::span(object.strings).subspan(2);
  std::size_t used = 0;
  const Transform transform = parseTransform(options, used, object.where);
  if (used != options.size()) {
    throw inputError(object.where, "brightfunc '" + object.name + "': '" + options[used] + "' is no transform option");
  }
  RadObject canonical = object;
  canonical.type = Type::SkyBrightness;
  canonical.strings.clear();
  canonical.reals = skyArguments(sky, Vec3(0, 0, 1));
  object = placed(canonical, Placement{transform, false, {}, {}});
}

std::vector<double> skyArguments(const RadianceSky& sky, const Vec3& up) {
  const Vec3& sun = sky.sunDirection;
  return {
      static_cast<double>(sky.kind), sky.zenith, sky.ground, sky.normalization, sun.x, sun.y, sun.z, up.x, up.y, up.z};
}

RadianceSky skyOf(const RadObject& object) {
  const std::vector<double>& a = object.reals;
  const auto kind = static_cast<RadianceSky::Kind>(static_cast<int>(a[0]));
  return {kind, a[1], a[2], a[3], glm::normalize(Vec3(a[4], a[5], a[6]))};
}

Vec3 zenithOf(const RadObject& object) {
  return glm::normalize(Vec3(object.reals[7], object.reals[8], object.reals[9]));
}

}  // namespace deltalux::io::radiance
