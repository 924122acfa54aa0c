#include <gtest/gtest.h>

#include "base/random.hpp"
#include "stats/chi_square.hpp"
#include "stats/distributions.hpp"
#include "stats/t_test.hpp"

namespace deltalux::test {
namespace {

// Tabulated quantiles (e.g. Abramowitz and Stegun, tables 26.8 and 26.10).
TEST(Distributions, TabulatedTails) {
  EXPECT_NEAR(chiSquareTail(3.841459, 1), 0.05, 1e-6);
  EXPECT_NEAR(chiSquareTail(18.307038, 10), 0.05, 1e-6);
  EXPECT_NEAR(chiSquareTail(135.806723, 100), 0.01, 1e-6);
  EXPECT_NEAR(studentTwoSidedTail(12.706205, 1), 0.05, 1e-6);
  EXPECT_NEAR(studentTwoSidedTail(2.228139, 10), 0.05, 1e-6);
  EXPECT_NEAR(studentTwoSidedTail(2.625891, 100), 0.01, 1e-6);
}

std::optional<Vec3> uniformDirection(const Vec3& u) {
  const double z = 1 - 2 * u.x, r = std::sqrt(1 - z * z), phi = 2 * kPi * u.y;
  return Vec3(r * std::cos(phi), r * std::sin(phi), z);
}

TEST(ChiSquare, AcceptsTheRightDensityAndRefusesAWrongOne) {
  const Vec3 axis = glm::normalize(Vec3(1, 2, -1));
  for (double concentration : {1.0, 3.0}) {
    const DirectionTest test{axis, concentration};
    EXPECT_GT(chiSquareDirections(
                  uniformDirection, [](const Vec3&) { return 1 / (4 * kPi); }, test)
                  .pValue,
              1e-3);
    const auto tilted = [](const Vec3& w) { return (1 + 0.1 * w.z) / (4 * kPi); };
    EXPECT_LT(chiSquareDirections(uniformDirection, tilted, test).pValue, 1e-6);
    const auto tooMuch = [](const Vec3&) { return 1.01 / (4 * kPi); };
    EXPECT_LT(chiSquareDirections(uniformDirection, tooMuch, test).pValue, 1e-6);
  }
}

TEST(TTest, AcceptsTheMeanAndRefusesAnother) {
  Rng rng(5);
  Moments moments;
  for (int i = 0; i < 10000; ++i) moments.add(rng.uniform());
  EXPECT_GT(tTest(moments, 0.5), 1e-3);
  EXPECT_LT(tTest(moments, 0.52), 1e-6);
}

}  // namespace
}  // namespace deltalux::test
