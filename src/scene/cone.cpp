#include <algorithm>

#include "base/unit_circle.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux::scene::kinds {

double area(const Cone& c) {
  return kPi * (c.radius0 + c.radius1) * std::hypot(glm::distance(c.p0, c.p1), c.radius1 - c.radius0);
}

Box bounds(const Cone& c) {
  const Vec3 axis = glm::normalize(c.p1 - c.p0);
  Box box = circleBounds(c.p0, axis, c.radius0);
  box.extend(circleBounds(c.p1, axis, c.radius1));
  return box;
}

SurfacePoint pointAt(const Cone& c, Vec2 uv) {
  const Vec3 along = c.p1 - c.p0;
  const double height = glm::length(along);
  const Frame frame(along / height);
  const Vec2 around = onUnitCircle(uv.x);
  const Vec3 radial = around.x * frame.tangent + around.y * frame.bitangent;
  const double radius = (1 - uv.y) * c.radius0 + uv.y * c.radius1;
  const Vec3 outward = glm::normalize(height * radial + (c.radius0 - c.radius1) * frame.normal);
  return {c.p0 + uv.y * along + radius * radial, c.inward ? -outward : outward, uv};
}

Vec2 parameterAt(const Cone& c, const Vec3& p) {
  const Vec3 along = c.p1 - c.p0;
  const double height = glm::length(along);
  const Vec3 local = Frame(along / height).toLocal(p - c.p0);
  // In the half plane through the axis and `p` the surface is a segment.
  const double slope = c.radius1 - c.radius0;
  const double v =
      ((std::hypot(local.x, local.y) - c.radius0) * slope + local.z * height) / (slope * slope + height * height);
  return {turnOf(local.x, local.y), std::clamp(v, 0.0, 1.0)};
}

SurfacePoint samplePoint(const Cone& c, Vec2 uniform) {
  // The area up to v grows as the square of the radius; solved for v without dividing by radius1 - radius0.
  const double r0 = c.radius0, r1 = c.radius1;
  const double radius = std::sqrt((1 - uniform.y) * r0 * r0 + uniform.y * r1 * r1);
  const double v = radius + r0 > 0 ? uniform.y * (r0 + r1) / (radius + r0) : 0.0;
  return pointAt(c, {uniform.x, std::min(v, 1.0)});
}

std::optional<Shape> transformed(const Cone& c, const ShapeMap& map) {
  if (!map.scale) return std::nullopt;
  return Cone{map.point(c.p0), map.point(c.p1), *map.scale * c.radius0, *map.scale * c.radius1, c.inward};
}

}  // namespace deltalux::scene::kinds
