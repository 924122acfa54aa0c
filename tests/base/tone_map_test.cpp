#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/image.hpp>
#include <limits>

#include "support/test_image.hpp"

namespace deltalux {
namespace {

Image onePixel(const Rgb& color) {
  Image image;
  image.width = image.height = 1;
  image.pixels = {color};
  return image;
}

std::array<std::uint8_t, 3> mapped(const Rgb& color, const ToneMapping& mapping) {
  return toneMap(onePixel(color), mapping).pixels[0];
}

TEST(ToneMap, LinearIsTheSrgbCurve) {
  EXPECT_NEAR(encodeSrgb(0.0), 0.0, 1e-12);
  EXPECT_NEAR(encodeSrgb(1.0), 1.0, 1e-12);
  EXPECT_NEAR(encodeSrgb(0.21404), 0.5, 1e-4);                  // tabulated: linear 0.2140 shows as 0.5
  EXPECT_NEAR(encodeSrgb(0.0031308), 12.92 * 0.0031308, 1e-6);  // both branches meet
  EXPECT_EQ(mapped(Rgb(0.21586f), {ToneOperator::Linear, 0})[1], 128);
}

TEST(ToneMap, EvCountsStops) {
  for (const ToneOperator op : {ToneOperator::Linear, ToneOperator::Reinhard})
    EXPECT_EQ(mapped(Rgb(0.1f), {op, 2.0}), mapped(Rgb(0.4f), {op, 0.0}));
  EXPECT_EQ(mapped(Rgb(0.25f), {ToneOperator::Linear, 2.0})[0], 255);
}

TEST(ToneMap, ReinhardReachesWhiteAtFour) {
  EXPECT_EQ(mapped(Rgb(4.0f), {})[0], 255);
  EXPECT_LT(mapped(Rgb(3.8f), {})[0], 255);
  EXPECT_EQ(mapped(Rgb(1.0f), {})[0], static_cast<int>(std::lround(255 * encodeSrgb(17.0 / 32.0))));
}

TEST(ToneMap, BrighterNeverGetsDarker) {
  for (const ToneOperator op : {ToneOperator::Linear, ToneOperator::Reinhard})
    for (const Rgb hue : {Rgb(1.0f), Rgb(1.0f, 0.1f, 0.0f), Rgb(0.0f, 0.2f, 1.0f)}) {
      double last = -1;
      for (double level = 1e-3; level < 100; level *= 1.1) {
        const auto p = mapped(static_cast<float>(level) * hue, {op, 0});
        const double Y =
            gray(glm::dvec3(std::pow(p[0] / 255.0, 2.2), std::pow(p[1] / 255.0, 2.2), std::pow(p[2] / 255.0, 2.2)));
        EXPECT_GE(Y, last - 0.01) << level;
        last = Y;
      }
      EXPECT_EQ(mapped(1e6f * hue, {op, 0}), (std::array<std::uint8_t, 3>{255, 255, 255}));
    }
}

TEST(ToneMap, HueIsKeptBelowTheGamut) {
  const auto p = mapped({0.4f, 0.2f, 0.1f}, {});
  const auto linear = [](int v) { return std::pow((v / 255.0 + 0.055) / 1.055, 2.4); };
  EXPECT_NEAR(linear(p[0]) / linear(p[1]), 2.0, 0.03);
  EXPECT_NEAR(linear(p[1]) / linear(p[2]), 2.0, 0.05);
}

TEST(ToneMap, WhatIsNotFiniteIsBlack) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  const std::array<std::uint8_t, 3> black{0, 0, 0};
  EXPECT_EQ(mapped(Rgb(nan), {}), black);
  EXPECT_EQ(mapped({1.0f, infinity, 0.0f}, {}), black);
  EXPECT_EQ(mapped(Rgb(-1.0f), {}), black);
}

TEST(AutomaticEv, PutsTheLogAverageAtTheKey) {
  Image image = test::mixedImage(30, 30);
  for (Rgb& pixel : image.pixels) pixel = Rgb(0.18f);
  EXPECT_DOUBLE_EQ(automaticEv(image), 0.0);
  for (Rgb& pixel : image.pixels) pixel *= 8.0f;
  EXPECT_DOUBLE_EQ(automaticEv(image), -3.0);
  EXPECT_DOUBLE_EQ(automaticEv(onePixel(Rgb(0.0f))), 0.0);
}

TEST(AutomaticEv, KeepsBrightPlacesInDarkSurroundings) {
  Image image = test::mixedImage(100, 10);
  for (int i = 0; i < 1000; ++i) image.pixels[i] = Rgb(i % 5 == 0 ? 8.0f : 0.001f);  // a fifth is bright
  EXPECT_DOUBLE_EQ(automaticEv(image), -3.0);
  for (int i = 0; i < 1000; ++i) image.pixels[i] = Rgb(i % 20 == 0 ? 8.0f : 0.18f);  // a twentieth: a lamp, say
  EXPECT_NEAR(automaticEv(image), -std::log2(8.0 / 0.18) / 20, 0.051);
}

TEST(ToneOperator, NamesGoThereAndBack) {
  for (const ToneOperator op : {ToneOperator::Linear, ToneOperator::Reinhard})
    EXPECT_EQ(toneOperatorByName(toneOperatorName(op)), op);
  EXPECT_EQ(toneOperatorByName("magic"), std::nullopt);
}

}  // namespace
}  // namespace deltalux
