// Properties that every kind of shape must have, each checked on a zoo of shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/shape.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

#include "base/random.hpp"

namespace deltalux {
namespace {

struct Named {
  std::string name;
  Shape shape;
};

Mesh tentMesh() {
  // Seven triangles of different sizes, so that the grid of cells has a half cell and empty cells.
  std::vector<Vec3> positions{{0, 0, 0}, {2, 0, 0.5}, {2, 3, 0}, {0, 3, 1}, {1, 1, 2}, {5, 1, 0}, {5, 2, 1}, {6, 3, 4}};
  return *makeMesh(std::move(positions),
                   {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2}, {5, 6, 2}, {0, 0, 1}, {6, 7, 2}});
}

std::vector<Named> zoo() {
  return {
      {"rectangle", *makePolygon({{1, 1, 0}, {3, 1, 0}, {3, 2, 1}, {1, 2, 1}})},
      {"parallelogram", *makePolygon({{0, 0, 5}, {2, 1, 5}, {3, 4, 6}, {1, 3, 6}})},
      {"triangle", *makePolygon({{0, 0, 0}, {2, 0, 0}, {0, 1, 1}})},
      {"L", *makePolygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 1}, {1, 1, 1}, {1, 3, 3}, {0, 3, 3}})},
      {"frame", *makePolygon({{0, 0, 1},
                              {4, 0, 1},
                              {4, 4, 1},
                              {0, 4, 1},
                              {0, 0, 1},
                              {1, 1, 1},
                              {1, 3, 1},
                              {3, 3, 1},
                              {3, 1, 1},
                              {1, 1, 1}})},
      {"sphere", Sphere{{1, 2, 3}, 2.5, false}},
      {"bubble", Sphere{{-1, 0, 3}, 0.5, true}},
      {"cylinder", Cylinder{{1, 0, 0}, {2, 3, 1}, 0.7, false}},
      {"tube", Cylinder{{1, 0, 0}, {1, 0, -2}, 0.3, true}},
      {"cone", Cone{{0, 0, 0}, {1, 1, 2}, 1.5, 0, false}},
      {"frustum", Cone{{0, 1, 0}, {3, 1, 2}, 0.5, 1.2, false}},
      {"cup", Cone{{0, 1, 0}, {0, 1, 2}, 0.5, 1.5, true}},
      {"disk", Ring{{1, 1, 1}, glm::normalize(Vec3(1, 2, 2)), 0, 2}},
      {"ring", Ring{{1, 1, 1}, glm::normalize(Vec3(-1, 2, 0.5)), 1, 2}},
      {"mesh", tentMesh()},
  };
}

class Shapes : public testing::TestWithParam<Named> {};

TEST_P(Shapes, ParametersRoundTrip) {
  const Shape& shape = GetParam().shape;
  Rng rng(1);
  for (int i = 0; i < 5000; ++i) {
    const Vec2 uv(rng.uniform(), rng.uniform());
    if (!covers(shape, uv)) continue;
    const SurfacePoint p = pointAt(shape, uv);
    EXPECT_EQ(p.uv, uv);
    EXPECT_NEAR(glm::length(p.normal), 1, 1e-12);
    const Vec2 back = parameterAt(shape, p.position, p.triangle);
    EXPECT_NEAR(back.x, uv.x, 1e-7);
    EXPECT_NEAR(back.y, uv.y, 1e-7);
    EXPECT_LT(glm::distance(pointAt(shape, back).position, p.position), 1e-7);
  }
}

TEST_P(Shapes, ParametersOfPointsNearby) {
  // A point pushed off along the normal keeps its parameters.
  const Shape& shape = GetParam().shape;
  Rng rng(2);
  for (int i = 0; i < 500; ++i) {
    const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
    const Vec2 uv = parameterAt(shape, p.position + 1e-3 * p.normal, p.triangle);
    EXPECT_LT(glm::distance(pointAt(shape, uv).position, p.position), 1e-7);
  }
}

TEST_P(Shapes, CornersOfTheSquare) {
  const Shape& shape = GetParam().shape;
  for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1), Vec2(0.5, 0), Vec2(0.5, 1)}) {
    if (!covers(shape, uv)) continue;
    const SurfacePoint p = pointAt(shape, uv);
    const Vec2 back = parameterAt(shape, p.position, p.triangle);
    EXPECT_TRUE(covers(shape, back));
    EXPECT_LT(glm::distance(pointAt(shape, back).position, p.position), 1e-7);
  }
  EXPECT_FALSE(covers(shape, {-0.1, 0.5}));
  EXPECT_FALSE(covers(shape, {0.5, 1.1}));
  EXPECT_FALSE(covers(shape, {std::nan(""), 0.5}));
}

TEST_P(Shapes, AreaIsTheIntegralOfTheJacobian) {
  const Shape& shape = GetParam().shape;
  constexpr int n = 400;
  constexpr double h = 1e-6;
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2 uv((i + 0.5) / n, (j + 0.5) / n);
      if (!covers(shape, uv)) continue;
      const Vec3 du = pointAt(shape, {uv.x + h, uv.y}).position - pointAt(shape, {uv.x - h, uv.y}).position;
      const Vec3 dv = pointAt(shape, {uv.x, uv.y + h}).position - pointAt(shape, {uv.x, uv.y - h}).position;
      const double jacobian = glm::length(glm::cross(du, dv)) / (4 * h * h);
      // The difference across the edge of a mesh's cell is no derivative.
      if (jacobian < 1e4) sum += jacobian / (n * n);
    }
  EXPECT_NEAR(sum, area(shape), 0.01 * area(shape));
}

TEST_P(Shapes, BoundsHoldAndAreTight) {
  const Shape& shape = GetParam().shape;
  const Box box = bounds(shape);
  Box seen;
  Rng rng(4);
  for (int i = 0; i < 200000; ++i) seen.extend(samplePoint(shape, {rng.uniform(), rng.uniform()}).position);
  const double slack = 1e-9 * box.diagonal(), gap = 0.02 * box.diagonal();
  for (int k = 0; k < 3; ++k) {
    EXPECT_GE(seen.lower[k], box.lower[k] - slack);
    EXPECT_LE(seen.upper[k], box.upper[k] + slack);
    EXPECT_NEAR(seen.lower[k], box.lower[k], gap);
    EXPECT_NEAR(seen.upper[k], box.upper[k], gap);
  }
}

/// Pearson's statistic as standard deviations from its mean, for many degrees of freedom.
double chiSquareDeviation(const std::vector<double>& observed, const std::vector<double>& expected) {
  double statistic = 0, freedom = -1;
  for (std::size_t i = 0; i < observed.size(); ++i)
    if (expected[i] >= 5)
      statistic += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i], ++freedom;
  return (statistic - freedom) / std::sqrt(2 * freedom);
}

TEST_P(Shapes, SamplesAreUniformByArea) {
  // Cells of [0,1]^2 get samples in proportion to their area, known from the Jacobian of many small steps.
  const Shape& shape = GetParam().shape;
  constexpr int cells = 8, fine = 60, samples = 200000;
  constexpr double h = 1e-7;
  std::vector<double> expected(cells * cells), observed(cells * cells);
  double total = 0;
  Rng rng(6);
  for (int i = 0; i < cells * fine; ++i)
    for (int j = 0; j < cells * fine; ++j) {
      const Vec2 uv = Vec2(i + rng.uniform(), j + rng.uniform()) / double(cells * fine);
      if (!covers(shape, uv)) continue;
      const Vec3 p = pointAt(shape, uv).position;
      const double jacobian = glm::length(
          glm::cross(pointAt(shape, {uv.x + h, uv.y}).position - p, pointAt(shape, {uv.x, uv.y + h}).position - p));
      expected[(i / fine) * cells + j / fine] += jacobian, total += jacobian;
    }
  for (double& e : expected) e *= samples / total;
  for (int i = 0; i < samples; ++i) {
    const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
    ASSERT_TRUE(covers(shape, p.uv)) << p.uv.x << " " << p.uv.y;
    const auto column = std::min(static_cast<int>(p.uv.x * cells), cells - 1);
    const auto row = std::min(static_cast<int>(p.uv.y * cells), cells - 1);
    ++observed[column * cells + row];
  }
  EXPECT_LT(chiSquareDeviation(observed, expected), 5);
}

TEST_P(Shapes, SampleKnowsItsPoint) {
  const Shape& shape = GetParam().shape;
  Rng rng(7);
  for (int i = 0; i < 2000; ++i) {
    const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
    const SurfacePoint again = pointAt(shape, p.uv);
    EXPECT_LT(glm::distance(again.position, p.position), 1e-7);
    EXPECT_EQ(again.triangle, p.triangle);
    EXPECT_GT(glm::dot(again.normal, p.normal), 1 - 1e-9);
  }
}

TEST_P(Shapes, SimilaritiesMoveThePointsAndKeepTheFront) {
  const Shape& shape = GetParam().shape;
  Rng rng(8);
  for (const bool mirror : {false, true}) {
    Mat4 map = glm::translate(Mat4(1), Vec3(3, -2, 7)) * glm::rotate(Mat4(1), 1.1, Vec3(1, 2, -1)) *
               glm::scale(Mat4(1), Vec3(2.5, 2.5, mirror ? -2.5 : 2.5));
    const auto image = transformed(shape, map);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->index(), shape.index());
    EXPECT_NEAR(area(*image), 6.25 * area(shape), 1e-9 * area(*image));
    for (int i = 0; i < 500; ++i) {
      const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
      const Vec3 moved(map * glm::dvec4(p.position, 1));
      const Vec3 front = glm::normalize(Vec3(map * glm::dvec4(p.normal, 0)));
      const SurfacePoint q = pointAt(*image, parameterAt(*image, moved, p.triangle));
      EXPECT_LT(glm::distance(q.position, moved), 1e-6);
      EXPECT_GT(glm::dot(q.normal, front), 1 - 1e-9);
    }
  }
}

TEST_P(Shapes, OtherAffineMapsSuitFlatShapesOnly) {
  const Shape& shape = GetParam().shape;
  const auto stretched = transformed(shape, glm::scale(Mat4(1), Vec3(1, 2, -3)));
  const bool flat = std::holds_alternative<Polygon>(shape) || std::holds_alternative<Mesh>(shape);
  EXPECT_EQ(stretched.has_value(), flat);
  EXPECT_FALSE(transformed(shape, glm::scale(Mat4(1), Vec3(0))));
  EXPECT_FALSE(transformed(shape, glm::scale(Mat4(1), Vec3(std::nan("")))));
  if (!stretched) return;
  Rng rng(10);
  for (int i = 0; i < 200; ++i) {
    const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
    const Vec3 moved = p.position * Vec3(1, 2, -3), front = (p.position + p.normal) * Vec3(1, 2, -3);
    const SurfacePoint q = pointAt(*stretched, parameterAt(*stretched, moved, p.triangle));
    EXPECT_LT(glm::distance(q.position, moved), 1e-6);
    EXPECT_GT(glm::dot(q.normal, front - moved), 0) << "what lay in front lies in front";
  }
}

void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }

INSTANTIATE_TEST_SUITE_P(Zoo, Shapes, testing::ValuesIn(zoo()), [](const auto& test) { return test.param.name; });

TEST(Shape, ClosedFormAreas) {
  EXPECT_DOUBLE_EQ(area(Sphere{{0, 0, 0}, 2, false}), 16 * kPi);
  EXPECT_DOUBLE_EQ(area(Cylinder{{0, 0, 0}, {0, 0, 3}, 2, false}), 12 * kPi);
  EXPECT_DOUBLE_EQ(area(Cone{{0, 0, 0}, {0, 0, 4}, 3, 0, false}), 15 * kPi);
  EXPECT_DOUBLE_EQ(area(Ring{{0, 0, 0}, {0, 0, 1}, 1, 2}), 3 * kPi);
}

TEST(Shape, FrontsFaceOutUnlessInward) {
  Rng rng(12);
  for (int i = 0; i < 100; ++i) {
    const Vec2 uv(rng.uniform(), rng.uniform());
    const SurfacePoint out = pointAt(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, false}, uv);
    const SurfacePoint in = pointAt(Cylinder{{0, 0, 0}, {0, 0, 1}, 1, true}, uv);
    EXPECT_NEAR(glm::dot(out.normal, Vec3(Vec2(out.position), 0)), 1, 1e-12);
    EXPECT_NEAR(glm::dot(in.normal, Vec3(Vec2(in.position), 0)), -1, 1e-12);
    EXPECT_GT(pointAt(Cone{{0, 0, 0}, {0, 0, 1}, 1, 0, false}, uv).normal.z, 0.7);
  }
}

TEST(Shape, TightBoundsOfATiltedDisk) {
  const Box box = bounds(Ring{{0, 0, 0}, glm::normalize(Vec3(1, 0, 1)), 0, 1});
  EXPECT_NEAR(box.upper.x, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(box.upper.y, 1, 1e-12);
}

TEST(Shape, MovedPolygonKeepsItsParameters) {
  const Shape shape = *makePolygon({{0, 0, 0}, {3, 0, 0}, {3, 1, 1}, {1, 1, 1}, {1, 3, 3}, {0, 3, 3}});
  const Mat4 map = glm::translate(Mat4(1), Vec3(0.1, 0.7, -3)) * glm::rotate(Mat4(1), 0.3, Vec3(0, 0, 1));
  const auto moved = transformed(shape, map);
  ASSERT_TRUE(moved);
  for (const Vec2 uv : {Vec2(0.1, 0.2), Vec2(0.9, 0.05)})
    EXPECT_LT(glm::distance(pointAt(*moved, uv).position, Vec3(map * glm::dvec4(pointAt(shape, uv).position, 1))),
              1e-12);
}

TEST(Shape, MeshWithoutAreaIsNone) {
  EXPECT_FALSE(makeMesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}, {0, 0, 1}}));
  EXPECT_FALSE(makeMesh({}, {}));
  EXPECT_THROW(makeMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}), std::logic_error);
  EXPECT_THROW(makeMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{0, 0, 1}}), std::logic_error);
}

TEST(Shape, MeshKeepsItsTrianglesApart) {
  // A mesh large enough for a real grid: each triangle's centroid finds its own way back.
  std::vector<Vec3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  constexpr std::uint32_t n = 40;
  for (std::uint32_t i = 0; i <= n; ++i)
    for (std::uint32_t j = 0; j <= n; ++j) positions.emplace_back(i, j, std::sin(0.3 * i) * std::cos(0.2 * j));
  for (std::uint32_t i = 0; i < n; ++i)
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t a = i * (n + 1) + j, b = a + n + 1;
      triangles.push_back({a, b, b + 1});
      triangles.push_back({a, b + 1, a + 1});
    }
  const Shape mesh = *makeMesh(positions, triangles);
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (const std::uint32_t corner : triangles[t]) {
      const Vec2 uv = parameterAt(mesh, positions[corner], t);
      EXPECT_EQ(pointAt(mesh, uv).triangle, t);
      EXPECT_LT(glm::distance(pointAt(mesh, uv).position, positions[corner]), 1e-7);
    }
}

TEST(Shape, TessellatedPolygonCounts) {
  EXPECT_EQ(tessellatedPolygonCount(Sphere{}), 288u);
  EXPECT_EQ(tessellatedPolygonCount(Cylinder{}), 24u);
  EXPECT_EQ(tessellatedPolygonCount(Ring{}), 24u);
  EXPECT_EQ(tessellatedPolygonCount(tentMesh()), 7u);
  EXPECT_EQ(tessellatedPolygonCount(*makePolygon({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})), 1u);
}

}  // namespace
}  // namespace deltalux
