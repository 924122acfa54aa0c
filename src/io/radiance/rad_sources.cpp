#include "io/radiance/rad_sources.hpp"

#include <cmath>

#include "base/sky_side.hpp"

namespace deltalux::io::radiance {

namespace {

/// Of the radius of the largest source that is a sun, and no part of the sky: one cell of all around.
constexpr double kCosineOfSun = 1 - 2.0 / (kSkySide * kSkySide);  // [defined]

DomeLight dome(const Vec3& axis, double degrees, const Rgb& colour) {
  DomeLight light;
  light.axis = axis;
  light.halfAngle = glm::radians(degrees / 2);
  light.scale = colour;
  light.distribution = UniformSky{1.0};
  return light;
}

}  // namespace

std::optional<Light> makeSource(const RadObject& object, const Modifier& modifier, const Scene& scene) {
  const std::string subject = "source '" + object.name + "': ";
  const Vec3 direction(object.reals[0], object.reals[1], object.reals[2]);
  const double degrees = object.reals[3];
  if (!(glm::length(direction) > 0)) throw inputError(object.where, subject + "its direction is zero");
  if (!(degrees >= 0 && degrees <= 360)) {
    throw inputError(object.where, subject + "its angle is not between 0 and 360 degrees");
  }
  if (!modifier.material.valid() || degrees < 1e-9) return std::nullopt;
  const Material& material = scene[modifier.material];
  if (!material.emission) return std::nullopt;
  const Vec3 axis = glm::normalize(direction);
  Light light{object.name, {}, Rgb(1.0f)};
  const bool isGlow = modifier.materialType == Type::Glow;
  if (!isGlow && degrees <= 2 * glm::degrees(std::acos(kCosineOfSun))) {
    light.emitter = SunLight{axis, glm::radians(degrees / 2), material.emission->radiance};
  } else {
    light.emitter = dome(axis, degrees, material.emission->radiance);
  }
  return light;
}

}  // namespace deltalux::io::radiance
