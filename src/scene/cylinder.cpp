#include <algorithm>

#include "base/unit_circle.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux::scene::kinds {

double area(const Cylinder& c) { return 2 * kPi * c.radius * glm::distance(c.p0, c.p1); }

Box bounds(const Cylinder& c) {
  const Vec3 axis = glm::normalize(c.p1 - c.p0);
  Box box = circleBounds(c.p0, axis, c.radius);
  box.extend(circleBounds(c.p1, axis, c.radius));
  return box;
}

SurfacePoint pointAt(const Cylinder& c, Vec2 uv) {
  const Vec3 along = c.p1 - c.p0;
  const Frame frame(glm::normalize(along));
  const Vec2 around = onUnitCircle(uv.x);
  const Vec3 radial = around.x * frame.tangent + around.y * frame.bitangent;
  return {c.p0 + uv.y * along + c.radius * radial, c.inward ? -radial : radial, uv};
}

Vec2 parameterAt(const Cylinder& c, const Vec3& p) {
  const Vec3 along = c.p1 - c.p0;
  const Frame frame(glm::normalize(along));
  const Vec3 d = p - c.p0;
  return {turnOf(glm::dot(d, frame.tangent), glm::dot(d, frame.bitangent)),
          std::clamp(glm::dot(d, along) / glm::dot(along, along), 0.0, 1.0)};
}

SurfacePoint samplePoint(const Cylinder& c, Vec2 uniform) { return pointAt(c, uniform); }

std::optional<Shape> transformed(const Cylinder& c, const ShapeMap& map) {
  if (!map.scale) return std::nullopt;
  return Cylinder{map.point(c.p0), map.point(c.p1), *map.scale * c.radius, c.inward};
}

}  // namespace deltalux::scene::kinds
