#include <cmath>
#include <deltalux/light.hpp>

namespace deltalux {

Rgb radiantIntensity(const PointLight& light, const Vec3& /*direction*/) { return light.intensity; }

Rgb radiantIntensity(const SpotLight& light, const Vec3& direction) {
  // [KHR_lights_punctual, inner and outer cone angles]
  const double scale = 1.0 / std::max(0.001, light.cosInner - light.cosOuter);
  const double angular = std::clamp((glm::dot(light.direction, direction) - light.cosOuter) * scale, 0.0, 1.0);
  return light.intensity * static_cast<float>(angular * angular);
}

Rgb radiantIntensity(const LambertPointLight& light, const Vec3& direction) {
  return light.intensity * static_cast<float>(std::max(0.0, glm::dot(light.direction, direction)));
}

double solidAngle(const SunLight& sun) {
  // 2 pi (1 - cos r) loses all digits for a sun of half a degree.
  const double halfSine = std::sin(0.5 * sun.angularRadius);
  return 4.0 * kPi * halfSine * halfSine;
}

}  // namespace deltalux
