#include "io/turned_over.hpp"

#include <algorithm>

namespace deltalux::io {

Shape turnedOver(const Shape& shape) {
  Shape result = shape;
  if (auto* polygon = std::get_if<Polygon>(&result)) {
    std::vector<Vec3> vertices = polygon->vertices;
    std::ranges::reverse(vertices);
    if (auto turned = makePolygon(vertices)) *polygon = std::move(*turned);
  } else if (auto* mesh = std::get_if<Mesh>(&result)) {
    auto triangles = mesh->triangles;
    for (auto& t : triangles) std::swap(t[1], t[2]);
    std::vector<Vec3> normals = mesh->normals;
    for (Vec3& n : normals) n = -n;
    if (auto turned = makeMesh(mesh->positions, std::move(triangles), std::move(normals), mesh->texcoords))
      *mesh = std::move(*turned);
  } else if (auto* ring = std::get_if<Ring>(&result)) {
    ring->normal = -ring->normal;
  } else {
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.inward; }) s.inward = !s.inward;
        },
        result);
  }
  return result;
}

}  // namespace deltalux::io
