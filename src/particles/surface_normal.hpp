#pragma once
// The normal of a shape where a path has been.
#include <deltalux/shape.hpp>

namespace deltalux::particles {

/// Unit normal of the front at a point of the surface, for meshes that of `triangle`.
inline Vec3 normalAt(const Shape& shape, const Vec3& p, std::uint32_t triangle) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const auto& t = mesh->triangles[triangle];
    const Vec3& p0 = mesh->positions[t[0]];
    return glm::normalize(glm::cross(mesh->positions[t[1]] - p0, mesh->positions[t[2]] - p0));
  }
  return pointAt(shape, parameterAt(shape, p)).normal;
}

}  // namespace deltalux::particles
