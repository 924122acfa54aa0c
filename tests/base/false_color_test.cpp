#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/image.hpp>
#include <limits>

namespace deltalux {
namespace {

/// A ramp of illuminance over three decades, one lux value per column.
Image ramp(int width, int height, double lowest, double highest) {
  Image image;
  image.width = width;
  image.height = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double lux = lowest * std::pow(highest / lowest, static_cast<double>(x) / (width - 1));
      image.pixels.push_back(Rgb(static_cast<float>(lux / kLuminousEfficacy)));
    }
  return image;
}

double brightness(const std::array<std::uint8_t, 3>& p) { return 0.30 * p[0] + 0.59 * p[1] + 0.11 * p[2]; }

TEST(FalseColor, BrightnessRisesWithTheValue) {
  const DisplayImage display = falseColor(ramp(200, 100, 1, 1000), {1000, 3});
  const int legend = display.width - 200;
  for (int x = 1; x < 200; ++x)
    EXPECT_GE(brightness(display.at(legend + x, 50)), brightness(display.at(legend + x - 1, 50)) - 1.0) << x;
  EXPECT_GT(brightness(display.at(legend + 199, 50)), brightness(display.at(legend, 50)) + 150.0);
}

TEST(FalseColor, LegendShowsTheSameColoursAsThePicture) {
  const DisplayImage display = falseColor(ramp(200, 300, 1, 1000), {1000, 3});
  const int legend = display.width - 200;
  EXPECT_GT(legend, 30);
  // The bar's top is the colour of 1000 lux; some row of the bar has the colour of the middle of the ramp.
  const int barColumn = 6;
  bool topFound = false, middleFound = false;
  for (int y = 0; y < display.height; ++y) {
    topFound |= display.at(barColumn, y) == display.at(legend + 199, 50);
    const auto a = display.at(barColumn, y), b = display.at(legend + 100, 50);
    middleFound |= std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) < 8;
  }
  EXPECT_TRUE(topFound);
  EXPECT_TRUE(middleFound);
}

TEST(FalseColor, ScaleFitsThePictureByItself) {
  // Automatic top for values up to 900 lux is 1000: the same picture as when asked for.
  EXPECT_EQ(falseColor(ramp(100, 80, 1, 900), {}).pixels, falseColor(ramp(100, 80, 1, 900), {1000, 3}).pixels);
  EXPECT_NE(falseColor(ramp(100, 80, 1, 900), {}).pixels, falseColor(ramp(100, 80, 1, 900), {2000, 3}).pixels);
}

TEST(FalseColor, PixelsWithoutSurfaceAreGrey) {
  Image image = ramp(20, 20, 1, 1000);
  image.at(3, 3) = Rgb(-1.0f);
  image.at(4, 3) = Rgb(std::numeric_limits<float>::quiet_NaN());
  const DisplayImage display = falseColor(image, {1000, 3});
  const int legend = display.width - 20;
  for (const int x : {3, 4}) {
    const auto p = display.at(legend + x, 3);
    EXPECT_TRUE(p[0] == p[1] && p[1] == p[2]) << x;
  }
}

TEST(FalseColor, AnyPictureSizeIsFine) {
  for (const int height : {1, 5, 20, 700}) EXPECT_EQ(falseColor(ramp(2, height, 1, 10), {}).height, height);
  Image black = ramp(8, 8, 1, 1);
  for (Rgb& pixel : black.pixels) pixel = Rgb(0.0f);
  EXPECT_EQ(falseColor(black).height, 8);
}

}  // namespace
}  // namespace deltalux
