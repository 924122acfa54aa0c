#include "base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltalux {
namespace {

TEST(Random, MeanAndVarianceOfUniform) {
  Rng rng(7);
  constexpr int n = 100000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double u = rng.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u, squares += u * u;
  }
  EXPECT_NEAR(sum / n, 0.5, 4 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(squares / n - sum * sum / n / n, 1.0 / 12, 1e-3);
}

TEST(Random, KeysGiveDifferentSequencesAndRepeat) {
  Rng a(1, 2), b(1, 3), again(1, 2);
  const std::uint64_t first = a.bits();
  EXPECT_NE(first, b.bits());
  EXPECT_EQ(first, again.bits());
}

}  // namespace
}  // namespace deltalux
