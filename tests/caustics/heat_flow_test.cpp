// Smoothing keeps flux and even light, is Gaussian, and knows no seams.
#include "caustics/wide_flow.hpp"

#include <gtest/gtest.h>

#include "caustics/scale_space.hpp"
#include "caustics/shapes.hpp"
#include "caustics/synthetic.hpp"

namespace deltalux {
namespace {

class FlowOver : public testing::TestWithParam<test::NamedShape> {};

std::vector<float> unevenConductivity(const CellGrid& grid) {
  std::vector<float> D;
  Rng rng(3);
  for (std::size_t i = 0; i < grid.size(); ++i) D.push_back(static_cast<float>(grid.meanArea() * 40 * rng.uniform()));
  return D;
}

TEST_P(FlowOver, KeepsFluxAndEvenLight) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 40, 32);
  const HeatFlow flow(grid, unevenConductivity(grid));
  std::vector<float> even(grid.size(), 2.0f), spot(grid.size(), 0.0f);
  spot[grid.size() / 3] = 1.0f;
  const double before = grid.area(grid.size() / 3);
  flow.apply(even, 1.0), flow.apply(spot, 1.0);
  double after = 0, least = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(even[i], 2.0f, 4e-4f);
    after += double(spot[i]) * grid.area(i);
    least = std::min(least, double(spot[i]));
  }
  EXPECT_NEAR(after, before, 1e-4 * before);
  EXPECT_GT(least, -1e-4);
}
TEST_P(FlowOver, KeepsFluxAndEvenLightOverCoarserCells) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 40, 32);
  CellPyramid pyramid(grid, {});
  Channels E(2, std::vector<float>(grid.size(), 0.0f));
  const std::size_t spot = grid.size() / 3;
  for (float& e : E[0]) e = 2.0f;
  E[1][spot] = 1.0f;
  flowWidely(pyramid, E, unevenConductivity(grid));
  double flux = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(E[0][i], 2.0f, 4e-4f);
    flux += double(E[1][i]) * grid.area(i);
  }
  EXPECT_NEAR(flux, grid.area(spot), 1e-4 * grid.area(spot));
}

TEST_P(FlowOver, ScalesAreAsWideAsTheySay) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 96, 80);
  CellLight light;
  Rng rng(11);
  for (std::size_t i = 0; i < grid.size(); ++i)
    light.gray.push_back(static_cast<float>(rng.uniform() * grid.meanArea() / grid.area(i))),
        light.squares.push_back(1.0f);
  CellPyramid pyramid(grid, {});
  ScaleSpace space(pyramid, light, 8);
  while (space.widen()) {
  }
  ASSERT_GE(space.levels().size(), 8u);
  const HeatFlow flow(grid, std::vector<float>(grid.size(), 0.5f));
  std::vector<float> widest = light.gray;
  flow.apply(widest, 1e3 * grid.totalArea(), 1e-3);
  for (const ScaleLevel& level : space.levels()) {
    std::vector<float> exact = light.gray;
    flow.apply(exact, level.width * level.width);
    double difference = 0, noise = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const double d = level.light[0][i] - exact[i], n = exact[i] - widest[i];
      difference += grid.area(i) * d * d, noise += grid.area(i) * n * n;
      ASSERT_NEAR(level.light[1][i], 1.0f, 1e-3f);
    }
    EXPECT_LT(std::sqrt(difference / noise), 0.2) << level.width / std::sqrt(grid.meanArea());
  }
}
INSTANTIATE_TEST_SUITE_P(Kinds, FlowOver, testing::ValuesIn(test::causticShapes()),
                         [](const auto& kind) { return kind.param.name; });

TEST(HeatFlow, SpreadsAPointToAGaussian) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 101, 101);
  std::vector<float> E(grid.size(), 0.0f);
  const std::size_t middle = grid.cellAt({0.5, 0.5});
  E[middle] = 1 / grid.area(middle);
  constexpr double width = 0.06;
  HeatFlow(grid, std::vector<float>(grid.size(), 0.5f * float(width * width))).apply(E, 1.0);
  for (const Vec2 d : {Vec2(0, 0), Vec2(0.05, 0), Vec2(0.04, 0.04), Vec2(0, 0.1), Vec2(0.099, -0.099)}) {
    const double exact = std::exp(-glm::dot(d, d) / (2 * width * width)) / (2 * kPi * width * width);
    EXPECT_NEAR(E[grid.cellAt(Vec2(0.5) + d)], exact, 0.01 / (2 * kPi * width * width)) << d.x << ' ' << d.y;
  }
}

TEST(WideFlow, SpreadsLikeHeatFlow) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 101, 101);
  for (const double width : {0.03, 0.06, 0.08}) {
    const std::vector<float> D(grid.size(), 0.5f * float(width * width));
    Channels E(1, std::vector<float>(grid.size(), 0.0f));
    const std::size_t middle = grid.cellAt({0.5, 0.5});
    E[0][middle] = 1 / grid.area(middle);
    std::vector<float> exact = E[0];
    CellPyramid pyramid(grid, {});
    flowWidely(pyramid, E, D);
    HeatFlow(grid, D).apply(exact, 1.0);
    double misplaced = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) misplaced += 0.5 * grid.area(i) * std::abs(E[0][i] - exact[i]);
    EXPECT_LT(misplaced, 0.05) << width;
  }
}

TEST(WideFlow, DoesNotCrossClosedBorders) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 31, 31);
  const auto inside = [&](std::size_t i) { return i % 31 + i / 31 < 30; };  // walls along a diagonal
  std::vector<float> open(grid.borders());
  grid.forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t border, bool) {
    open[border] = inside(a) == inside(b) ? 1.0f : 0.0f;
  });
  CellPyramid pyramid(grid, open);
  Channels E(1, std::vector<float>(grid.size(), 0.0f));
  for (std::size_t i = 0; i < grid.size(); ++i) E[0][i] = inside(i) ? 1.0f : 0.0f;
  flowWidely(pyramid, E, std::vector<float>(grid.size(), 20 * float(grid.meanArea())));
  for (std::size_t i = 0; i < grid.size(); ++i) ASSERT_NEAR(E[0][i], inside(i) ? 1.0f : 0.0f, 1e-4f);
}

/// E after a spot of light at uv has spread, read at uv + du.
double spreadTo(const Shape& shape, const Vec2& from, const Vec2& to) {
  const Charts charts = chartsOf(shape);
  const CellGrid grid = test::gridOver(shape, charts, 128, 64);
  std::vector<float> E(grid.size(), 0.0f);
  const auto cellAt = [&](const Vec2& uv) { return grid.cellAt(charts.all[0].place(pointAt(shape, uv))); };
  E[cellAt(from)] = 1 / grid.area(cellAt(from));
  HeatFlow(grid, std::vector<float>(grid.size(), 0.5f)).apply(E, 0.02);
  return E[cellAt(to)];
}

TEST(HeatFlow, RunsOnOverTheSeam) {
  for (const Shape& shape : {Shape(Cylinder{{0, 0, 0}, {0, 0, 1}, 0.5}), Shape(Sphere{{0, 0, 0}, 0.5}),
                             Shape(Cone{{0, 0, 0}, {0, 0, 1}, 0.5, 0.2})}) {
    const double inside = spreadTo(shape, {0.504, 0.5}, {0.473, 0.5});
    const double over = spreadTo(shape, {0.004, 0.5}, {0.973, 0.5});
    EXPECT_NEAR(over, inside, 1e-3 * inside);
  }
}

TEST(HeatFlow, RunsOnOverThePole) {
  // Two points of a sphere at the same distance: by way of the pole, and along the equator. (Centres of cells.)
  const Shape sphere = Sphere{{0, 0, 0}, 0.5};
  const double theta = 2.5 * kPi / 64, v = 0.5 * (1 + std::cos(theta));
  const double over = spreadTo(sphere, {0.26, v}, {0.76, v});
  const double along = spreadTo(sphere, {0.5, 0.49}, {0.5 + 2 * theta / (2 * kPi), 0.49});
  EXPECT_NEAR(over, along, 0.03 * along);
}

TEST(HeatFlow, DoesNotCrossClosedBorders) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 20, 20);
  std::vector<float> open(grid.borders());
  grid.forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t border, bool) {
    open[border] = (a % 20 < 10) == (b % 20 < 10) ? 1.0f : 0.0f;
  });
  std::vector<float> E(grid.size(), 0.0f);
  for (std::size_t i = 0; i < grid.size(); ++i) E[i] = i % 20 < 10 ? 1.0f : 0.0f;
  HeatFlow(grid, std::vector<float>(grid.size(), 1.0f), open).apply(E, 1.0);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_NEAR(E[i], i % 20 < 10 ? 1.0f : 0.0f, 1e-4f);
}

}  // namespace
}  // namespace deltalux
