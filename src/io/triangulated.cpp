#include "io/triangulated.hpp"

#include <algorithm>
#include <deltalux/shape.hpp>

namespace deltalux::io {

std::vector<std::array<std::uint32_t, 3>> triangulated(const std::vector<Vec3>& outline) {
  if (outline.size() > 3)
    if (const auto polygon = makePolygon(outline); polygon && polygon->vertices.size() == outline.size())
      return polygon->triangles;
  std::vector<std::array<std::uint32_t, 3>> fan;
  for (std::uint32_t i = 1; i + 1 < outline.size(); ++i) fan.push_back({0, i, i + 1});
  return fan;
}

bool hasArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = glm::length(glm::cross(b - a, c - a)), longest = std::max(glm::length(b - a), glm::length(c - a));
  return area > 1e-12 * longest * longest && area > 1e-300;
}

}  // namespace deltalux::io
