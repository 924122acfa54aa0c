#include <gtest/gtest.h>

#include "base/random.hpp"
#include "export/rgb9e5.hpp"

namespace deltalux {
namespace {

using exporting::packRgb9e5;
using exporting::unpackRgb9e5;

TEST(Rgb9e5, HasTheWordsOfTheSpecification) {
  EXPECT_EQ(packRgb9e5(Rgb(0.0f)), 0u);
  // 1 = 256 * 2^(16 - 24): exponent 16, mantissa 256.
  EXPECT_EQ(packRgb9e5(Rgb(1, 0, 0)), 16u << 27 | 256u);
  EXPECT_EQ(packRgb9e5(Rgb(0, 1, 0)), 16u << 27 | 256u << 9);
  EXPECT_EQ(packRgb9e5(Rgb(0, 0, 1)), 16u << 27 | 256u << 18);
  EXPECT_EQ(unpackRgb9e5(31u << 27 | 511u), Rgb(65408, 0, 0));
}

TEST(Rgb9e5, KeepsTheGreatestChannelToAFiveHundredth) {
  Rng random(1, 2);
  for (int i = 0; i < 10000; ++i) {
    const auto number = [&] { return static_cast<float>(std::exp2(20 * random.uniform() - 8)); };
    const Rgb c(number(), number(), number());
    const Rgb back = unpackRgb9e5(packRgb9e5(c));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], c[k], maxChannel(c) / 511);
  }
}

TEST(Rgb9e5, TakesWhatIsNoLightForNone) {
  EXPECT_EQ(packRgb9e5(Rgb(-1.0f, std::numeric_limits<float>::quiet_NaN(), 0.0f)), 0u);
  EXPECT_EQ(unpackRgb9e5(packRgb9e5(Rgb(std::numeric_limits<float>::infinity()))), Rgb(65408.0f));
  EXPECT_EQ(unpackRgb9e5(packRgb9e5(Rgb(511.9f, 0, 0))), Rgb(512, 0, 0));  // rounds up into the next exponent
}

}  // namespace
}  // namespace deltalux
