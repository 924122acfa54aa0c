#include "export/lightmap_side_light.hpp"

#include <cmath>

namespace deltalux::exporting {

namespace {

constexpr float kOutside = -1e-3f;  // weights of points on a triangle's edge [rounding]

std::vector<BoxF> boxesOf(const SurfaceMesh& side) {
  std::vector<BoxF> boxes(side.triangles.size() / 3);
  for (std::size_t i = 0; i < side.triangles.size(); ++i)
    boxes[i / 3].extend(side.vertices[side.triangles[i]].position);
  return boxes;
}

}  // namespace

std::optional<glm::vec2> weightsOn(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& p, float reach) {
  const Vec3f normal = glm::cross(b - a, c - a);
  const float squared = glm::dot(normal, normal);
  if (!(squared > 0)) return std::nullopt;
  if (std::abs(glm::dot(p - a, normal)) > reach * std::sqrt(squared)) return std::nullopt;
  const glm::vec2 w(glm::dot(glm::cross(p - a, c - a), normal) / squared,
                    glm::dot(glm::cross(b - a, p - a), normal) / squared);
  return w.x < kOutside || w.y < kOutside || w.x + w.y > 1 - kOutside ? std::nullopt : std::optional(w);
}

SideLight::SideLight(const SurfaceMesh& side) : side_(side), tree_(boxesOf(side)) {}

std::optional<Rgb> SideLight::at(const Vec3f& position, float reach) const {
  std::optional<Rgb> found;
  tree_.overlapping({position - reach, position + reach}, [&](std::uint32_t i) {
    if (found) return;
    const auto corner = [&](std::uint32_t k) -> const MeshVertex& {
      return side_.vertices[side_.triangles[3 * i + k]];
    };
    const MeshVertex &a = corner(0), &b = corner(1), &c = corner(2);
    if (const auto w = weightsOn(a.position, b.position, c.position, position, reach)) {
      const Rgb E = irradianceOf(a);
      found = glm::max(E + w->x * (irradianceOf(b) - E) + w->y * (irradianceOf(c) - E), Rgb(0.0f));
    }
  });
  return found;
}

}  // namespace deltalux::exporting
