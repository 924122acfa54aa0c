#include "radiosity/direction_code.hpp"

#include <cmath>

namespace deltalux::radiosity {

DirectionCode directionCode(const Vec3f& direction) {
  const float scale = 1.0f / (std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z));
  const Vec3f d = scale * direction;
  float x = d.x, y = d.y;
  if (d.z < 0) {
    x = (1 - std::abs(d.y)) * (d.x < 0 ? -1.0f : 1.0f);
    y = (1 - std::abs(d.x)) * (d.y < 0 ? -1.0f : 1.0f);
  }
  const auto byte = [](float u) { return static_cast<std::int8_t>(std::lround(127.0f * u)); };
  return {byte(x), byte(y)};
}

}  // namespace deltalux::radiosity
