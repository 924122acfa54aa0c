#pragma once
// One shape of each kind that carries caustic textures.
#include <deltalux/shape.hpp>
#include <string>

namespace deltalux::test {

struct NamedShape {
  std::string name;
  Shape shape;
};

/// A ball of triangles: 2 (rows - 1) columns.
inline Mesh ballMesh(int columns, int rows) {
  std::vector<Vec3> positions{{0, 0, -1}};
  for (int r = 1; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const double theta = kPi * r / rows, phi = 2 * kPi * c / columns;
      positions.push_back({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), -std::cos(theta)});
    }
  positions.push_back({0, 0, 1});
  const auto at = [&](int r, int c) {
    if (r == 0) return 0u;
    if (r == rows) return static_cast<std::uint32_t>(positions.size() - 1);
    return static_cast<std::uint32_t>(1 + (r - 1) * columns + c % columns);
  };
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (r > 0) triangles.push_back({at(r, c), at(r, c + 1), at(r + 1, c)});
      if (r + 1 < rows) triangles.push_back({at(r, c + 1), at(r + 1, c + 1), at(r + 1, c)});
    }
  return *makeMesh(std::move(positions), std::move(triangles));
}

inline std::vector<NamedShape> causticShapes() {
  return {{"square", *makePolygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}})},
          {"slanted", *makePolygon({{0, 0, 0}, {2, 0, 1}, {3, 1, 1.5}, {1, 1, 0.5}})},
          {"concave", *makePolygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}})},
          {"triangle", *makePolygon({{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0}})},
          {"sphere", Sphere{{1, 2, 3}, 0.7}},
          {"cylinder", Cylinder{{0, 0, 0}, {0, 1, 2}, 0.4}},
          {"cone", Cone{{0, 0, 0}, {0, 0, 2}, 0.8, 0}},
          {"frustum", Cone{{0, 0, 0}, {1, 0, 1}, 0.8, 0.5}},
          {"disc", Ring{{0, 0, 0}, {0, 0, 1}, 0, 1}},
          {"ring", Ring{{0, 0, 0}, glm::normalize(Vec3(1, 2, 3)), 0.4, 1}},
          {"mesh", ballMesh(24, 12)}};
}

}  // namespace deltalux::test
