#include "export/rgbm.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"

namespace deltalux {
namespace {

using exporting::kRgbmRange;
using exporting::packRgbm;
using exporting::unpackRgbm;
using Texel = std::array<std::uint8_t, 4>;

TEST(Rgbm, HasTheNumbersOfItsDefinition) {
  EXPECT_EQ(packRgbm(Rgb(kRgbmRange)), (Texel{255, 255, 255, 255}));
  EXPECT_EQ(packRgbm(Rgb(0.0f)), (Texel{0, 0, 0, 1}));
  EXPECT_NEAR(unpackRgbm({255, 0, 0, 128}).r, 34.49 * std::pow(128 / 255.0, 2.2), 1e-4);
}

TEST(Rgbm, KeepsTheGreatestChannelToTheStepOfEightBits) {
  Rng random(1, 2);
  for (int i = 0; i < 10000; ++i) {
    const auto number = [&] { return kRgbmRange * static_cast<float>(std::exp2(-12 * random.uniform())); };
    const Rgb c(number(), number(), number());
    const Texel texel = packRgbm(c);
    // One step of alpha may leave the channels unused by so much.
    const float step = std::pow((texel[3]) / float(texel[3] - 1), 2.2f) / 510;
    const Rgb back = unpackRgbm(texel);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(back[k], c[k], 1.001f * step * maxChannel(c));
  }
}

TEST(Rgbm, ClipsWhatItCannotSay) { EXPECT_EQ(packRgbm(Rgb(1e9f, -1, 0)), (Texel{255, 0, 0, 255})); }

}  // namespace
}  // namespace deltalux
