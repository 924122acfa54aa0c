#pragma once
// Meshes of as many faces as are asked for.
#include <deltalux/scene.hpp>

namespace deltalux::test {

/// The graph of `height` over a square from the origin, by 2 n n triangles, fronts up.
template <class Height>
Mesh ground(double size, std::uint32_t n, const Height& height) {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i <= n; ++i) {
      const Vec2 p = size * Vec2(i, j) / double(n);
      positions.emplace_back(p, height(p.x, p.y));
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      triangles.push_back({a, b, d}), triangles.push_back({a, d, c});
    }
  return *makeMesh(std::move(positions), std::move(triangles));
}

/// A ball of n bands from pole to pole and 2 n around: 4 n (n - 1) triangles; fronts outside.
inline Mesh ball(const Vec3& center, double radius, std::uint32_t n) {
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (std::uint32_t j = 0; j <= n; ++j)
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
      const double theta = kPi * j / n, phi = kPi * i / n;
      positions.push_back(
          center + radius * Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
      const std::uint32_t a = j * 2 * n + i, b = j * 2 * n + (i + 1) % (2 * n), c = a + 2 * n, d = b + 2 * n;
      if (j > 0) triangles.push_back({a, d, b});
      if (j + 1 < n) triangles.push_back({a, c, d});
    }
  return *makeMesh(std::move(positions), std::move(triangles));
}

}  // namespace deltalux::test
