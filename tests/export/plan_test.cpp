#include <deltalux/plan.hpp>

#include <gtest/gtest.h>

#include <cstdio>

#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

/// Eleven by four points whose light grows along the columns by 100 lux each.
struct Ramp {
  MeasuringGrid grid = gridOf({{0, 0, 0}, {11, 0, 0}, {0, 4, 0}}, 1, {.border = 0, .spacing = 1});
  std::vector<double> lux;
  Ramp() {
    for (const std::size_t cell : grid.cells) lux.push_back(100 * static_cast<double>(cell % 11) + 50);
  }
  Plan plan(std::string title = "ramp") const { return {grid, lux, std::move(title), 1}; }
};

TEST(Plan, DrawsLinesOfEqualIlluminanceWhereTheyAre) {
  const Ramp ramp;
  ASSERT_EQ(ramp.grid.columns, 11);
  const std::string svg = planSvg(ramp.plan());
  // 500 lx lies at the middle between the fifth and the sixth column's middles, at 5 of 11 cells.
  std::size_t on = 0;
  for (std::size_t at = svg.find("<path d=\"M"); at != std::string::npos; at = svg.find("<path d=\"M", at + 1)) {
    double x = 0, y = 0;
    ASSERT_EQ(std::sscanf(svg.c_str() + at + 10, "%lf %lf", &x, &y), 2);
    const double cells = (x - 44) / (640.0 / 11);
    const double lux = 100 * cells;
    EXPECT_NEAR(lux, 200 * std::round(lux / 200), 1) << x;
    ++on;
  }
  EXPECT_GE(on, 4u);
  EXPECT_NE(svg.find(">650</text>"), std::string::npos);
  EXPECT_NE(svg.find("11.00 x 4.00 m, 44 points"), std::string::npos);
  EXPECT_NE(svg.find("U0 0.09"), std::string::npos);
}

TEST(Plan, EscapesItsTitle) {
  const Ramp ramp;
  EXPECT_NE(planSvg(ramp.plan("a<b & c")).find("a&lt;b &amp; c"), std::string::npos);
}

TEST(Plan, ThePictureHasTheSameLines) {
  const Ramp ramp;
  const DisplayImage image = planImage(ramp.plan());
  const int left = image.width - 640;
  ASSERT_GT(left, 0);
  EXPECT_NEAR(image.height, 640 * 4 / 11.0, 1);
  std::vector<int> black;
  for (int x = 0; x < 640; ++x)
    if (image.at(left + x, image.height / 2) == std::array<std::uint8_t, 3>{0, 0, 0}) black.push_back(x);
  ASSERT_FALSE(black.empty());
  for (const int x : black) {
    const double lux = 100 * (x + 0.5) / (640.0 / 11);
    EXPECT_NEAR(lux, 200 * std::round(lux / 200), 3) << x;
  }
}

TEST(Plan, LeavesOutWhatIsOffTheSurface) {
  Ramp ramp;
  ramp.grid.points.erase(ramp.grid.points.begin()), ramp.grid.cells.erase(ramp.grid.cells.begin());
  ramp.lux.erase(ramp.lux.begin());
  const std::string all = planSvg(Ramp().plan()), less = planSvg(ramp.plan());
  const auto rects = [](const std::string& svg) {
    std::size_t n = 0;
    for (std::size_t at = svg.find("<rect"); at != std::string::npos; at = svg.find("<rect", at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(rects(all) - rects(less), 36u);
}

TEST(Plan, EvenLightHasNoLines) {
  Ramp ramp;
  std::ranges::fill(ramp.lux, 500.0);
  EXPECT_EQ(planSvg(ramp.plan()).find("<path"), std::string::npos);
  const test::TempFolder folder;
  savePlan(folder / "even.png", ramp.plan());
  savePlan(folder / "even.svg", ramp.plan());
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"even.png", "even.svg"}));
}

}  // namespace
}  // namespace deltalux
