// Leaving vertices out: light stays what it was, outlines stay where they were.
#include <gtest/gtest.h>

#include "export/simplify.hpp"

namespace deltalux {
namespace {

using namespace exporting;

constexpr int kSide = 16;

/// A square of n x n cells, each a fan about its middle; light by place.
template <class Light>
std::pair<PageMesh, std::vector<std::vector<Rgb>>> square(const Light& light) {
  PageMesh mesh;
  std::vector<std::vector<Rgb>> layers(1);
  const auto add = [&](float x, float y) {
    MeshVertex v;
    v.position = Vec3f(x, y, 0.25f * x), v.normal = Vec3f(0, 0, 1);
    mesh.vertices.push_back(v), layers[0].push_back(light(x, y));
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) add(float(x), float(y));
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::uint32_t a = std::uint32_t(y * (kSide + 1) + x), b = a + 1, d = a + kSide + 1, c = d + 1;
      const std::uint32_t m = add(float(x) + 0.5f, float(y) + 0.5f);
      for (const auto& [p, q] : {std::pair(a, b), {b, c}, {c, d}, {d, a}})
        mesh.triangles.insert(mesh.triangles.end(), {p, q, m});
    }
  mesh.sides = {{0, 0, static_cast<std::uint32_t>(mesh.vertices.size()), 0}};
  mesh.draws = {PageDraw{}};
  mesh.draws[0].count = static_cast<std::uint32_t>(mesh.triangles.size());
  return {mesh, layers};
}

double areaOf(const PageMesh& mesh) {
  double area = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
    const auto at = [&](std::size_t k) { return Vec3(mesh.vertices[mesh.triangles[i + k]].position); };
    const Vec3 n = glm::cross(at(1) - at(0), at(2) - at(0));
    EXPECT_GT(n.z, 0);
    area += 0.5 * n.z;
  }
  return area;
}

TEST(Simplify, LinearLightNeedsItsOutlineOnly) {
  auto [mesh, layers] = square([](float x, float y) { return Rgb(1 + x, 2 + y, 3 + x + y); });
  simplify(mesh, layers, {0.001});
  EXPECT_LT(mesh.vertices.size(), 4 * kSide + kSide);  // the outline, and few that no neighbour could take
  EXPECT_EQ(layers[0].size(), mesh.vertices.size());
  EXPECT_NEAR(areaOf(mesh), kSide * kSide, 1e-6);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_NEAR(layers[0][v].r, 1 + mesh.vertices[v].position.x, 1e-4);
}

TEST(Simplify, KeepsWhatAnEdgeOfLightNeeds) {
  const auto light = [](float x, float y) { return x + 0.3f * y < 8 ? Rgb(1.0f) : Rgb(10.0f); };
  auto [mesh, layers] = square(light);
  const std::size_t before = mesh.vertices.size();
  const PageMesh old = mesh;
  simplify(mesh, layers, {0.01});
  EXPECT_LT(mesh.vertices.size(), before / 2);
  EXPECT_NEAR(areaOf(mesh), kSide * kSide, 1e-6);
  // Every vertex that was there finds its light again.
  for (const MeshVertex& v : old.vertices) {
    bool found = false;
    for (std::size_t i = 0; i < mesh.triangles.size() && !found; i += 3) {
      const auto at = [&](std::size_t k) { return glm::dvec2(mesh.vertices[mesh.triangles[i + k]].position); };
      const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
      const glm::dvec2 p(v.position);
      const double whole = cross(at(1) - at(0), at(2) - at(0));
      const double b = cross(p - at(0), at(2) - at(0)) / whole, c = cross(at(1) - at(0), p - at(0)) / whole;
      if (std::min({1 - b - c, b, c}) < -1e-4) continue;
      const double E = (1 - b - c) * double(layers[0][mesh.triangles[i]].r) +
                       b * double(layers[0][mesh.triangles[i + 1]].r) + c * double(layers[0][mesh.triangles[i + 2]].r);
      found = std::abs(E - double(light(v.position.x, v.position.y).r)) < 0.02 * E;
    }
    EXPECT_TRUE(found) << v.position.x << ' ' << v.position.y;
  }
}

TEST(Simplify, EveryGroupCounts) {
  auto [mesh, layers] = square([](float x, float) { return Rgb(x < 4 ? 1.0f : 2.0f); });
  auto [same, other] = square([](float, float y) { return Rgb(y < 9 ? 100.0f : 300.0f); });
  layers.push_back(other[0]);
  auto one = std::vector<std::vector<Rgb>>{other[0]};
  simplify(same, one, {0.01});
  simplify(mesh, layers, {0.01});
  EXPECT_GT(mesh.vertices.size(), same.vertices.size());
}

}  // namespace
}  // namespace deltalux
