// Smoothing keeps flux and even light, has the kernel it says, and knows no seams.
#include "caustics/heat_flow.hpp"

#include <gtest/gtest.h>

#include "caustics/scale_space.hpp"
#include "caustics/shapes.hpp"
#include "caustics/synthetic.hpp"

namespace deltalux {
using namespace caustics;

namespace {

class FlowOver : public testing::TestWithParam<test::NamedShape> {};

Slots unevenConductivity(const CellGrid& grid, const CellRaster& raster) {
  std::vector<float> D;
  Rng rng(3);
  for (std::size_t i = 0; i < grid.size(); ++i) D.push_back(static_cast<float>(grid.meanArea() * 40 * rng.uniform()));
  return raster.laidOut(D);
}

/// By cell, of values by slot.
std::vector<float> byCell(const CellGrid& grid, const CellRaster& raster, const Slots& values) {
  std::vector<float> result;
  for (std::uint32_t i = 0; i < grid.size(); ++i) result.push_back(values[raster.slotOf(i)]);
  return result;
}

/// All values 0 but that of one cell.
Slots spotAt(const CellGrid& grid, const CellRaster& raster, std::size_t cell, float value) {
  std::vector<float> cells(grid.size(), 0.0f);
  cells[cell] = value;
  return raster.laidOut(cells);
}

TEST_P(FlowOver, KeepsFluxAndEvenLight) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 40, 32);
  const CellRaster raster(grid);
  const HeatFlow flow(raster, unevenConductivity(grid, raster));
  const std::size_t spot = grid.size() / 3;
  Channels E{raster.laidOut(std::vector<float>(grid.size(), 2.0f)), spotAt(grid, raster, spot, 1.0f)};
  flow.apply(E, 1.0);
  const std::vector<float> even = byCell(grid, raster, E[0]), spread = byCell(grid, raster, E[1]);
  double after = 0, least = 0;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    EXPECT_NEAR(even[i], 2.0f, 1e-4f);
    after += double(spread[i]) * grid.area(i);
    least = std::min(least, double(spread[i]));
  }
  EXPECT_NEAR(after, grid.area(spot), 1e-4 * grid.area(spot));
  EXPECT_GT(least, -1e-3);
}

TEST_P(FlowOver, TakesChannelsAsIfAlone) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 40, 32);
  const CellRaster raster(grid);
  const HeatFlow flow(raster, unevenConductivity(grid, raster));
  Channels together;
  for (const std::size_t part : {2u, 3u, 5u}) together.push_back(spotAt(grid, raster, grid.size() / part, 1.0f));
  Channels alone = together;
  flow.apply(together, 1.0);
  for (Slots& E : alone) flow.apply(E, 1.0);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(byCell(grid, raster, together[c]), byCell(grid, raster, alone[c]));
}

TEST_P(FlowOver, ScalesAreAsWideAsTheySay) {
  const Charts charts = chartsOf(GetParam().shape);
  const CellGrid grid = test::gridOver(GetParam().shape, charts, 96, 80);
  const CellRaster raster(grid);
  std::vector<float> noise;
  Rng rng(11);
  for (std::size_t i = 0; i < grid.size(); ++i)
    noise.push_back(static_cast<float>(rng.uniform() * grid.meanArea() / grid.area(i)));
  const Channels light{raster.laidOut(noise), raster.laidOut(std::vector<float>(grid.size(), 1.0f))};
  const HeatFlow flow(raster, {});
  ScaleSpace space(raster, flow, light);
  while (space.widen()) {
  }
  ASSERT_GE(space.levels().size(), 8u);
  Slots widest = light[0];
  flow.apply(widest, grid.totalArea());
  for (const ScaleLevel& level : space.levels()) {
    Slots exact = light[0];  // many short flows: a Gaussian
    for (int i = 0; i < 8; ++i) flow.apply(exact, level.width * level.width / 16);
    double difference = 0, variance = 0;
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
      const std::uint32_t slot = raster.slotOf(i);
      const double d = level.light[0][slot] - exact[slot], n = exact[slot] - widest[slot];
      difference += grid.area(i) * d * d, variance += grid.area(i) * n * n;
      ASSERT_NEAR(level.light[1][slot], 1.0f, 1e-3f);
    }
    EXPECT_LT(std::sqrt(difference / variance), 0.2) << level.width / std::sqrt(grid.meanArea());
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, FlowOver, testing::ValuesIn(test::causticShapes()),
                         [](const auto& kind) { return kind.param.name; });

TEST(HeatFlow, SpreadsAPointToItsKernel) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 101, 101);
  const CellRaster raster(grid);
  const std::uint32_t middle = grid.cellAt({0.5, 0.5});
  for (const double width : {0.08, 0.12}) {
    Slots E = spotAt(grid, raster, middle, 1 / grid.area(middle));
    HeatFlow(raster, Slots(raster.slots(), 0.5f * float(width * width))).apply(E, 1.0);
    const double R2 = 8 * width * width, peak = 3 / (kPi * R2);
    double variance = 0;
    for (std::uint32_t i = 0; i < grid.size(); ++i) {
      const std::uint32_t texel = grid.texelOf(i);
      const Vec2 d = (Vec2(texel % 101, texel / 101) - 50.0) / 101.0;
      const double inside = std::max(0.0, 1 - glm::dot(d, d) / R2);
      EXPECT_NEAR(E[raster.slotOf(i)], peak * inside * inside, 0.01 * peak) << d.x << ' ' << d.y;
      variance += double(E[raster.slotOf(i)]) * grid.area(i) * d.x * d.x;
    }
    EXPECT_NEAR(variance, width * width, 1e-3 * width * width);
  }
}

/// All borders open but those between cells that `side` tells apart.
template <class Side>
Borders closedBetween(const CellGrid& grid, const CellRaster& raster, const Side& side) {
  std::vector<float> sides(grid.size());
  for (std::uint32_t i = 0; i < grid.size(); ++i) sides[i] = side(grid.texelOf(i)) ? 1.0f : 0.0f;
  const Slots of = raster.laidOut(sides);
  Borders open;
  for (std::size_t b = 0; b < open.size(); ++b) {
    open[b].assign(raster.slots(), 1.0f);
    for (std::size_t i = raster.rowBegin(0); i < raster.rowBegin(raster.rows()); ++i)
      open[b][i] = of[i] == of[i + raster.across()[b]] ? 1.0f : 0.0f;
  }
  return open;
}

TEST(HeatFlow, DoesNotCrossClosedBorders) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 31, 31);
  const CellRaster raster(grid);
  const auto left = [](std::size_t texel) { return texel % 31 < 12; };
  const auto below = [](std::size_t texel) { return texel % 31 + texel / 31 < 30; };  // walls along a diagonal
  const auto check = [&](const auto& inside) {
    const Borders open = closedBetween(grid, raster, inside);
    Slots E(raster.slots(), 0.0f);
    for (std::uint32_t i = 0; i < grid.size(); ++i) E[raster.slotOf(i)] = inside(grid.texelOf(i)) ? 1.0f : 0.0f;
    HeatFlow(raster, Slots(raster.slots(), 20 * float(grid.meanArea())), &open).apply(E, 1.0);
    for (std::uint32_t i = 0; i < grid.size(); ++i)
      ASSERT_NEAR(E[raster.slotOf(i)], inside(grid.texelOf(i)) ? 1.0f : 0.0f, 1e-4f);
  };
  check(left), check(below);
}

/// E after a spot of light at uv has spread, read at uv + du.
double spreadTo(const Shape& shape, const Vec2& from, const Vec2& to) {
  const Charts charts = chartsOf(shape);
  const CellGrid grid = test::gridOver(shape, charts, 128, 64);
  const CellRaster raster(grid);
  const auto cellAt = [&](const Vec2& uv) { return grid.cellAt(charts.all[0].place(pointAt(shape, uv))); };
  Slots E = spotAt(grid, raster, cellAt(from), 1 / grid.area(cellAt(from)));
  HeatFlow(raster, Slots(raster.slots(), 0.5f)).apply(E, 0.02);
  return E[raster.slotOf(cellAt(to))];
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

}  // namespace
}  // namespace deltalux
