#include <algorithm>

#include "base/unit_circle.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux::scene::kinds {

double area(const Sphere& s) { return 4 * kPi * s.radius * s.radius; }

Box bounds(const Sphere& s) { return {s.center - Vec3(s.radius), s.center + Vec3(s.radius)}; }

SurfacePoint pointAt(const Sphere& s, Vec2 uv) {
  const Vec2 around = onUnitCircle(uv.x);
  const double sinTheta = 2 * std::sqrt(std::max(0.0, uv.y * (1 - uv.y)));
  const Vec3 radial(sinTheta * around.x, sinTheta * around.y, 2 * uv.y - 1);
  return {s.center + s.radius * radial, s.inward ? -radial : radial, uv};
}

Vec2 parameterAt(const Sphere& s, const Vec3& p) {
  const Vec3 d = p - s.center;
  const double length = glm::length(d);
  const double cosTheta = length > 0 ? d.z / length : 1.0;
  return {turnOf(d.x, d.y), std::clamp(0.5 * (1 + cosTheta), 0.0, 1.0)};
}

SurfacePoint samplePoint(const Sphere& s, Vec2 uniform) { return pointAt(s, uniform); }

std::optional<Shape> transformed(const Sphere& s, const ShapeMap& map) {
  if (!map.scale) return std::nullopt;
  return Sphere{map.point(s.center), *map.scale * s.radius, s.inward};
}

}  // namespace deltalux::scene::kinds
