// Smoothing keeps flux and even light, is Gaussian, and knows no seams.
#include "caustics/heat_flow.hpp"

#include <gtest/gtest.h>

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
  std::vector<float> open;
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (const CellGrid::Border& b : grid.bordersOf(i))
      open.push_back((i % 20 < 10) == (b.cell % 20 < 10) ? 1.0f : 0.0f);
  std::vector<float> E(grid.size(), 0.0f);
  for (std::size_t i = 0; i < grid.size(); ++i) E[i] = i % 20 < 10 ? 1.0f : 0.0f;
  HeatFlow(grid, std::vector<float>(grid.size(), 1.0f), open).apply(E, 1.0);
  for (std::size_t i = 0; i < grid.size(); ++i) EXPECT_NEAR(E[i], i % 20 < 10 ? 1.0f : 0.0f, 1e-4f);
}

}  // namespace
}  // namespace deltalux
