#include "scene/flat_outline.hpp"

#include <utility>

namespace deltalux::scene {

Vec3 newellVector(const std::vector<Vec3>& vertices) {
  Vec3 sum(0);
  for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
    sum += glm::cross(vertices[i] - vertices[0], vertices[i + 1] - vertices[0]);
  return 0.5 * sum;
}

std::vector<Vec2> flatOutline(const std::vector<Vec3>& vertices, const Vec3& normal) {
  const Vec3 size = glm::abs(normal);
  const int dropped = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  int first = (dropped + 1) % 3, second = (dropped + 2) % 3;
  if (normal[dropped] < 0) std::swap(first, second);
  std::vector<Vec2> outline;
  outline.reserve(vertices.size());
  for (const Vec3& v : vertices) outline.emplace_back(v[first], v[second]);
  return outline;
}

}  // namespace deltalux::scene
