// Charts keep lengths and areas, and know where surfaces are.
#include "caustics/chart.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "caustics/coverage.hpp"
#include "caustics/shapes.hpp"

namespace deltalux {
using namespace caustics;

namespace {

class ChartOfShape : public testing::TestWithParam<test::NamedShape> {};

TEST_P(ChartOfShape, CoveredAreasSumToTheSurface) {
  const Shape& shape = GetParam().shape;
  const Charts charts = chartsOf(shape);
  double sum = 0;
  for (std::size_t c = 0; c < charts.all.size(); ++c)
    for (const float a : coveredAreas(shape, charts, c, {Vec2(0), charts.all[c].size}, 50, 40)) sum += a;
  EXPECT_NEAR(sum, area(shape), 2e-3 * area(shape));
}

TEST_P(ChartOfShape, PlacesEveryPointWithinItsSize) {
  const Shape& shape = GetParam().shape;
  const Charts charts = chartsOf(shape);
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const double u = rng.uniform();
    const SurfacePoint p = samplePoint(shape, {u, rng.uniform()});
    const Chart& chart = charts.all[charts.indexOf(p.triangle)];
    const Vec2 st = chart.place(p);
    const double slack = 1e-9 * (chart.size.x + chart.size.y);
    EXPECT_TRUE(st.x >= -slack && st.y >= -slack && st.x <= chart.size.x + slack && st.y <= chart.size.y + slack);
  }
}

TEST_P(ChartOfShape, DistancesNearbyAreTrue) {
  const Shape& shape = GetParam().shape;
  const Charts charts = chartsOf(shape);
  const double stretched = std::holds_alternative<Mesh>(shape) ? 1.42 : 1.001;
  Rng rng(2);
  int compared = 0;
  for (int i = 0; i < 2000; ++i) {
    const double u = rng.uniform();
    const SurfacePoint p = samplePoint(shape, {u, rng.uniform()});
    const Vec3 aside = p.position + 1e-4 * Frame(p.normal).toWorld({std::cos(i), std::sin(i), 0});
    SurfacePoint q = p;
    if (std::holds_alternative<Mesh>(shape))
      q.position = aside;  // in the triangle's plane
    else
      q = pointAt(shape, parameterAt(shape, aside));
    const Chart& chart = charts.all[charts.indexOf(p.triangle)];
    const double true_ = glm::distance(p.position, q.position);
    const Vec2 a = chart.place(p), b = chart.place(q);
    if (true_ < 5e-5 || std::abs(a.x - b.x) > 0.5 * chart.size.x) continue;  // clamped to the rim; over the seam
    const Vec2 d((a.x - b.x) * chart.stretch(0.5 * (a.y + b.y)), a.y - b.y);
    if (chart.stretch(a.y) < 0.05) continue;  // next to a pole a straight step is none in (s,t)
    EXPECT_LT(glm::length(d), stretched * true_);
    EXPECT_GT(glm::length(d), true_ / stretched);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ChartOfShape, testing::ValuesIn(test::causticShapes()),
                         [](const auto& kind) { return kind.param.name; });

TEST(PolygonCharts, AreTheSmallestRectangle) {
  // A gable wall whose first edge is its roof.
  const Shape gable = *makePolygon({{2, 0, 3}, {4, 0, 2}, {4, 0, 0}, {0, 0, 0}, {0, 0, 2}});
  const Vec2 size = chartsOf(gable).all[0].size;
  EXPECT_NEAR(size.x * size.y, 12.0, 1e-9);
  EXPECT_NEAR(std::min(size.x, size.y), 3.0, 1e-9);
}

TEST(MeshCharts, CoverEveryTriangleOnceAndKeepPatchesTogether) {
  const Mesh ball = test::ballMesh(24, 12);
  const Charts charts = chartsOf(Shape(ball));
  EXPECT_GT(charts.all.size(), 4u);
  EXPECT_LT(charts.all.size(), 40u);
  for (const std::uint32_t c : charts.ofTriangle) EXPECT_LT(c, charts.all.size());
}

}  // namespace
}  // namespace deltalux
