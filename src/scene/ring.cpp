#include <algorithm>

#include "base/square.hpp"
#include "base/unit_circle.hpp"
#include "scene/shape_kinds.hpp"

namespace deltalux::scene::kinds {

namespace {}  // namespace

double area(const Ring& r) { return kPi * (square(r.outerRadius) - square(r.innerRadius)); }

Box bounds(const Ring& r) { return circleBounds(r.center, r.normal, r.outerRadius); }

SurfacePoint pointAt(const Ring& r, Vec2 uv) {
  const Frame frame(r.normal);
  const Vec2 around = onUnitCircle(uv.x);
  const double radius = std::sqrt((1 - uv.y) * square(r.innerRadius) + uv.y * square(r.outerRadius));
  const Vec3 offset = radius * (around.x * frame.tangent + around.y * frame.bitangent);
  return {r.center + offset, r.normal, uv};
}

Vec2 parameterAt(const Ring& r, const Vec3& p) {
  const Vec3 local = Frame(r.normal).toLocal(p - r.center);
  const double v =
      (local.x * local.x + local.y * local.y - square(r.innerRadius)) / (square(r.outerRadius) - square(r.innerRadius));
  return {turnOf(local.x, local.y), std::clamp(v, 0.0, 1.0)};
}

SurfacePoint samplePoint(const Ring& r, Vec2 uniform) { return pointAt(r, uniform); }

std::optional<Shape> transformed(const Ring& r, const ShapeMap& map) {
  if (!map.scale) return std::nullopt;
  return Ring{map.point(r.center), glm::normalize(map.linear * r.normal), *map.scale * r.innerRadius,
              *map.scale * r.outerRadius};
}

}  // namespace deltalux::scene::kinds
