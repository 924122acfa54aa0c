#include "base/unit_circle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltalux {
namespace {

TEST(UnitCircle, IsCosineAndSineOfTurns) {
  for (int i = -50000; i <= 50000; ++i) {
    const double turns = i / 10007.0;
    const long double angle = 2 * 3.14159265358979323846264338327950288L * turns;
    const Vec2 p = onUnitCircle(turns);
    EXPECT_NEAR(p.x, static_cast<double>(std::cos(angle)), 3e-15) << turns;
    EXPECT_NEAR(p.y, static_cast<double>(std::sin(angle)), 3e-15) << turns;
  }
}

TEST(UnitCircle, QuartersAreExact) {
  for (int quarters = -9; quarters <= 9; ++quarters) {
    const Vec2 p = onUnitCircle(0.25 * quarters);
    EXPECT_EQ(std::abs(p.x) + std::abs(p.y), 1.0);
    EXPECT_EQ(p.x * p.y, 0.0);
  }
  EXPECT_EQ(onUnitCircle(0.0), Vec2(1, 0));
  EXPECT_EQ(onUnitCircle(0.25), Vec2(0, 1));
}

}  // namespace
}  // namespace deltalux
