#include "glare/fisheye.hpp"

#include <cmath>

#include "glare/sight_frame.hpp"

namespace deltalux {

std::optional<Vec3> fisheyeDirection(const Eye& eye, double x, double y) {
  const double r = std::hypot(x, y), theta = r * kPi / 2;
  if (r > 1) return std::nullopt;
  const glare::SightFrame f(eye);
  const double scale = r > 0 ? std::sin(theta) / r : 0;
  return glm::normalize(scale * x * f.right + scale * y * f.above + std::cos(theta) * f.ahead);
}

Vec2 fisheyePlace(const Eye& eye, const Vec3& towards) {
  const Vec3 d = glm::normalize(glare::SightFrame(eye).toLocal(towards));
  const double off = std::hypot(d.x, d.y);
  return off > 0 ? std::atan2(off, d.z) * 2 / kPi / off * Vec2(d.x, d.y) : Vec2(0.0);
}

namespace glare {

std::optional<FisheyePixel> fisheyePixel(const Eye& eye, int size, int x, int y) {
  const double u = (2 * x + 1.0) / size - 1, v = 1 - (2 * y + 1.0) / size, r = std::hypot(u, v);
  const std::optional<Vec3> direction = fisheyeDirection(eye, u, v);
  if (!direction) return std::nullopt;
  // r is theta over pi / 2, so d omega = sin(theta) / theta (pi / 2)^2 dA.
  const double theta = r * kPi / 2, side = kPi / size;
  return FisheyePixel{*direction, (theta > 0 ? std::sin(theta) / theta : 1.0) * side * side};
}

}  // namespace glare

}  // namespace deltalux
