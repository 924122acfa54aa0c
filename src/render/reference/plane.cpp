#include "render/reference/plane.hpp"

#include <algorithm>

namespace deltalux::rendering {

std::optional<Plane> planeOf(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return Plane{polygon->vertices.front(), polygon->normal};
  if (const auto* ring = std::get_if<Ring>(&shape)) return Plane{ring->center, glm::normalize(ring->normal)};
  return std::nullopt;
}

bool contains(const Shape& shape, const Vec3& p) {
  if (const auto* ring = std::get_if<Ring>(&shape)) {
    const double r = glm::length(p - ring->center);
    return r >= ring->innerRadius && r <= ring->outerRadius;
  }
  const auto& polygon = std::get<Polygon>(shape);
  return std::any_of(polygon.triangles.begin(), polygon.triangles.end(), [&](const std::array<std::uint32_t, 3>& t) {
    const Vec3 &a = polygon.vertices[t[0]], &b = polygon.vertices[t[1]], &c = polygon.vertices[t[2]];
    const auto inside = [&](const Vec3& from, const Vec3& to) {
      return glm::dot(glm::cross(to - from, p - from), polygon.normal) >= 0.0;
    };
    return inside(a, b) && inside(b, c) && inside(c, a);
  });
}

}  // namespace deltalux::rendering
