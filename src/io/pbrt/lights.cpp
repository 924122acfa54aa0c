#include "io/pbrt/lights.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::io::pbrt {

namespace {

/// The light's colour in `name`, times its scale; where `power` (or illuminance) is said, that over what rgb 1 has.
Rgb brightness(Context& context, const Entity& light, std::string_view name, std::string_view power, double ofOne) {
  constexpr double kMost = 1e25;  // radiance or intensity [limit]
  const double scale = numberOr(light, "scale", 1), wanted = numberOr(light, power, -1);
  if (scale < 0) fail(light.at, "the light's scale is negative");
  const RgbSum all = RgbSum(lightColourOf(context, light, name)) * scale * (wanted > 0 ? wanted / ofOne : 1.0);
  if (!(std::max({all.r, all.g, all.b}) <= kMost)) fail(light.at, "the light is too bright");
  return Rgb(all);
}

Vec3 unit(const Entity& light, const Vec3& direction) {
  if (!(glm::length(direction) > 0)) fail(light.at, "the light shines nowhere");
  return glm::normalize(direction);
}

}  // namespace

void addLight(Context& context, Scene& scene, const Entity& e, const Mat4& toWorld) {
  const auto add = [&](auto emitter) {
    scene.lights.push_back({e.type + std::to_string(scene.lights.size()), std::move(emitter), Rgb(1.0f)});
  };
  const Vec3 from = pointOr(e, "from", Vec3(0)), to = pointOr(e, "to", {0, 0, 1});
  const Vec3 position(toWorld * glm::dvec4(from, 1));
  if (e.type == "point") {
    add(PointLight{position, brightness(context, e, "I", "power", 4 * kPi)});
  } else if (e.type == "spot") {
    const double cone = std::clamp(numberOr(e, "coneangle", 30), 0.01, 90.0);
    const double inner = std::clamp(cone - numberOr(e, "conedeltaangle", 5), 0.0, cone);
    const double cosInner = std::cos(glm::radians(inner)), cosOuter = std::cos(glm::radians(cone));
    add(SpotLight{position, unit(e, glm::dmat3(toWorld) * (to - from)),
                  brightness(context, e, "I", "power", 2 * kPi * (1 - 0.5 * (cosInner + cosOuter))), cosInner,
                  cosOuter});
  } else if (e.type == "distant") {
    SunLight sun;
    sun.direction = unit(e, glm::dmat3(toWorld) * (from - to));
    sun.radiance = brightness(context, e, "L", "illuminance", 1) * static_cast<float>(1 / solidAngle(sun));
    add(sun);
  } else if (e.type == "infinite" && !find(e, "filename")) {
    DomeLight dome;
    dome.axis = dome.up = scene.up, dome.halfAngle = kPi;
    dome.scale = brightness(context, e, "L", "illuminance", kPi), dome.distribution = UniformSky{1};
    add(dome);
  } else {
    ignore(context, "light " + e.type.substr(0, 40) + (e.type == "infinite" ? " of an image" : ""));
  }
}

std::optional<Emission> emissionOf(Context& context, const Entity& e, double area) {
  if (e.type != "diffuse" || find(e, "filename")) {
    ignore(context, "area light " + e.type.substr(0, 40) + (e.type == "diffuse" ? " of an image" : ""));
    return std::nullopt;
  }
  Emission emission;
  emission.bothSides = flagOr(e, "twosided", false);
  emission.radiance = brightness(context, e, "L", "power", (emission.bothSides ? 2 : 1) * kPi * area);
  if (isBlack(emission.radiance)) return std::nullopt;
  return emission;
}

}  // namespace deltalux::io::pbrt
