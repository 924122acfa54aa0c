// The parts that names and samples of particles are made of.
#include <gtest/gtest.h>

#include "base/random.hpp"
#include "particles/radix_tree.hpp"
#include "particles/solid_angle_rectangle.hpp"
#include "particles/surface_cells.hpp"
#include "scene/light_sampling_triangle.hpp"
#include "stats/chi_square.hpp"

namespace deltalux {
using namespace particles;

namespace {

constexpr double kSignificance = 1e-4;

/// By two triangles. [OS83]
double solidAngleOf(const Rectangle& r, const Vec2& low, const Vec2& high, const Vec3& from) {
  const auto towards = [&](double x, double y) { return glm::normalize(r.at({x, y}) - from); };
  const Vec3 a = towards(low.x, low.y), b = towards(high.x, low.y), c = towards(high.x, high.y),
             d = towards(low.x, high.y);
  return scene::sphericalTriangleArea(a, b, c) + scene::sphericalTriangleArea(a, c, d);
}

TEST(SolidAngleRectangle, SamplesUniformly) {
  const Rectangle r{{-0.3, -0.5, 0.4}, {1, 0, 0}, {0, 1, 0}, 1.0, 1.4};
  constexpr int grid = 12, samples = 200000;
  for (const Vec3& from : {Vec3(0, 0, 0), Vec3(0.8, -0.9, 0.1), Vec3(0.1, 0.2, 0.395), Vec3(0.2, 0.2, 1.3)}) {
    const SolidAngleRectangle seen(r, from);
    EXPECT_NEAR(seen.solidAngle() / solidAngleOf(r, {0, 0}, {1, 1}, from), 1.0, 1e-9);
    std::vector<double> observed(grid * grid, 0.0), expected;
    Rng rng(11);
    for (int i = 0; i < samples; ++i) {
      const double u = rng.uniform();
      const Vec2 s = seen.sample({u, rng.uniform()});
      const auto bin = [](double x) { return std::min(static_cast<int>(grid * x), grid - 1); };
      observed[grid * bin(s.y) + bin(s.x)] += 1;
    }
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i)
        expected.push_back(samples / seen.solidAngle() *
                           solidAngleOf(r, Vec2(i, j) / double(grid), Vec2(i + 1, j + 1) / double(grid), from));
    const auto result = test::chiSquare(observed, expected);
    EXPECT_GT(result.pValue, kSignificance) << result.message;
  }
}

TEST(SurfaceCells, SampleNumbersUndoSamplePoint) {
  const Shape shapes[] = {
      *makePolygon({{0, 0, 0}, {2, 0, 0}, {2.5, 1, 0}, {1, 1.7, 0}, {-0.2, 0.8, 0}}),
      *makePolygon({{0, 0, 0}, {2, 0, 0}, {2.5, 1, 0}, {0.5, 1, 0}}),
      Sphere{{1, 2, 3}, 0.7},
      Cylinder{{0, 0, 0}, {1, 1, 1}, 0.3},
      Cone{{0, 0, 0}, {0, 1, 1}, 0.5, 0.1},
      Ring{{0, 0, 0}, {0, 0, 1}, 0.2, 0.9},
      *makeMesh({{1, 1, 0}, {1.5, 1.2, 0}, {1.2, 1.6, 0.6}, {0.8, 1.3, 1}}, {{0, 1, 2}, {0, 2, 3}})};
  for (const Shape& shape : shapes) {
    Rng rng(5);
    for (int i = 0; i < 200; ++i) {
      const Vec2 u(rng.uniform(), rng.uniform());
      const SurfacePoint p = samplePoint(shape, u);
      Vec2 uv = parameterAt(shape, p.position, p.triangle);
      if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        const auto& t = mesh->triangles[p.triangle];
        const Vec3 a = mesh->positions[t[0]], e1 = mesh->positions[t[1]] - a, e2 = mesh->positions[t[2]] - a;
        const Vec3 n = glm::cross(e1, e2), d = p.position - a;
        uv = Vec2(glm::dot(glm::cross(d, e2), n), glm::dot(glm::cross(e1, d), n)) / glm::dot(n, n);
      }
      const Vec2 back = sampleNumbers(shape, p.triangle, uv);
      EXPECT_NEAR(back.x, u.x, 1e-6) << shape.index();
      EXPECT_NEAR(back.y, u.y, 1e-6) << shape.index();
    }
  }
}

TEST(SurfaceCells, CoverTheSquareOnce) {
  const Vec2 size(5, 1);
  for (const int halves : {0, 1, 4, 7}) {
    const std::vector<UnitCell> cells = cellsOf(size, halves);
    EXPECT_EQ(cells.size(), std::size_t(1) << halves);
    double sum = 0;
    for (const UnitCell& c : cells) sum += c.rect.measure();
    EXPECT_NEAR(sum, 1, 1e-12);
    Rng rng(3);
    for (int i = 0; i < 100; ++i) {
      const Vec2 p(rng.uniform(), rng.uniform());
      const UnitRect& r = cells[cellAt(size, halves, p)].rect;
      EXPECT_TRUE(p.x >= r.u0 && p.x <= r.u1 && p.y >= r.v0 && p.y <= r.v1);
    }
  }
}

std::vector<Code> codes(int count) {
  std::vector<Code> all;
  for (int i = 0; i < count; ++i) all.push_back({std::uint32_t(i % 7), std::uint32_t(mix64(i)), std::uint32_t(i), 0});
  std::sort(all.begin(), all.end());
  return all;
}

TEST(RadixTree, NodesKeepTheirNamesWhenThingsAreAdded) {
  std::vector<Code> few = codes(200), more = few;
  more.push_back({3, 17, 4, 9});
  std::sort(more.begin(), more.end());
  std::vector<RadixNode> a, b;
  appendRadixTree(a, few, 0, 1);
  appendRadixTree(b, more, 0, 1);
  EXPECT_EQ(a.size(), 2 * few.size() - 1);
  std::vector<std::uint64_t> keys;
  for (const RadixNode& n : b) keys.push_back(n.key);
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::unique(keys.begin(), keys.end()), keys.end());
  std::size_t lost = 0;
  for (const RadixNode& n : a) lost += !std::binary_search(keys.begin(), keys.end(), n.key);
  EXPECT_EQ(lost, 0u);
}

TEST(RadixTree, ChildrenShareTheirParentsLeaves) {
  const std::vector<Code> all = codes(300);
  std::vector<RadixNode> nodes;
  const std::uint32_t root = appendRadixTree(nodes, all, 10, 1);
  EXPECT_EQ(nodes[root].begin, 10u);
  EXPECT_EQ(nodes[root].end, 310u);
  for (const RadixNode& n : nodes) {
    if (n.isLeaf()) {
      EXPECT_EQ(n.end, n.begin + 1);
      continue;
    }
    EXPECT_EQ(nodes[n.child[0]].begin, n.begin);
    EXPECT_EQ(nodes[n.child[0]].end, nodes[n.child[1]].begin);
    EXPECT_EQ(nodes[n.child[1]].end, n.end);
  }
}

}  // namespace
}  // namespace deltalux
