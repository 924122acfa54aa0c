// Exponentials and logarithms made for vector code agree with the library's.
#include "caustics/vector_math.hpp"

#include <gtest/gtest.h>

namespace deltalux {
using namespace caustics;

namespace {

TEST(VectorMath, ExponentialsAgree) {
  for (double x = -86; x < 88; x += 0.037) {
    const double exact = std::exp(double(static_cast<float>(x)));
    EXPECT_NEAR(expOf(static_cast<float>(x)), exact, 2e-5 * exact) << x;
  }
  EXPECT_EQ(expOf(0.0f), 1.0f);
  EXPECT_LT(expOf(-1e30f), 2e-38f);
}

TEST(VectorMath, LogarithmsAgree) {
  for (double x = 1e-37; x < 1e38; x *= 1.013) {
    const double exact = std::log(double(static_cast<float>(x)));
    EXPECT_NEAR(logOf(static_cast<float>(x)), exact, 1e-6 * std::max(1.0, std::abs(exact))) << x;
  }
}

}  // namespace
}  // namespace deltalux
