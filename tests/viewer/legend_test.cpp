// The scale of false colour.
#include "panels/legend.hpp"

#include <gtest/gtest.h>

using namespace deltalux::viewer;

TEST(Legend, HasATickWhereTheLogarithmicScaleHasTheValue) {
  FalseColour f;
  f.top = 1000, f.decades = 3, f.logarithmic = true;
  const auto ticks = legendTicks(f);
  ASSERT_EQ(ticks.size(), 10u);  // 1 2 5 10 ... 1000
  EXPECT_NEAR(ticks.front().value, 1, 1e-9);
  EXPECT_NEAR(ticks.front().position, 0, 1e-9);
  EXPECT_NEAR(ticks.back().position, 1, 1e-9);
  for (const LegendTick& t : ticks) EXPECT_NEAR(t.value, 1000 * std::pow(10, 3 * (t.position - 1)), 1e-6 * t.value);
}

TEST(Legend, TellsLinearScalesAndStepsApart) {
  FalseColour f;
  f.top = 500, f.logarithmic = false;
  for (const LegendTick& t : legendTicks(f)) EXPECT_NEAR(t.value, 500 * t.position, 1e-9);
  f.useBands = true, f.bands = {300, 500, 750};
  const auto steps = legendTicks(f);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_DOUBLE_EQ(steps[1].value, 500);
  EXPECT_DOUBLE_EQ(steps[1].position, 0.5);  // four colours, a step between each two
}
