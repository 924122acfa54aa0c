#include <deltalux/glare.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "glare/fisheye.hpp"

namespace deltalux {
namespace {

const Eye kEye{{0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr int kSize = 400;

/// A dim picture with bright discs.
class Picture {
 public:
  Picture() {
    image.width = image.height = kSize, image.luminousEfficacy = 100;
    image.pixels.assign(kSize * kSize, Rgb(0.1f));
  }
  void disc(const Vec3& towards, double radius, double luminance) {
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        if (const auto p = glare::fisheyePixel(kEye, kSize, x, y))
          if (std::acos(glm::dot(p->direction, glm::normalize(towards))) < radius)
            image.at(x, y) = Rgb(static_cast<float>(luminance / 100));
  }
  Image image;
};

TEST(FisheyePixels, FillTheHalfSphere) {
  double omega = 0, projected = 0;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      if (const auto p = glare::fisheyePixel(kEye, kSize, x, y))
        omega += p->solidAngle, projected += p->solidAngle * p->direction.y;
  EXPECT_NEAR(omega, 2 * kPi, 0.001 * 2 * kPi);
  EXPECT_NEAR(projected, kPi, 0.001 * kPi);
}

TEST(GlareSources, HaveTheirLuminanceSolidAngleAndPlace) {
  Picture picture;
  const Vec3 towards(0.5, 1, 0.4);
  picture.disc(towards, 0.1, 5000);
  const auto sources = glareSources(picture.image, kEye);
  ASSERT_EQ(sources.size(), 1u);
  EXPECT_NEAR(sources[0].luminance, 5000, 1);
  EXPECT_NEAR(sources[0].solidAngle, 2 * kPi * (1 - std::cos(0.1)), 0.01 * 0.0314);
  EXPECT_NEAR(std::acos(glm::dot(sources[0].direction, glm::normalize(towards))), 0, 0.002);
  EXPECT_NEAR(sources[0].positionIndex, positionIndex(kEye, towards), 0.01 * positionIndex(kEye, towards));
}

TEST(GlareSources, MergeWhatLiesTogetherAndNothingElse) {
  Picture picture;
  picture.disc({-0.1, 1, 0}, 0.03, 4000);
  picture.disc({0.1, 1, 0}, 0.03, 8000);   // 0.14 from rim to rim
  picture.disc({0, 1, 0.9}, 0.05, 30000);  // far above
  picture.disc({1, 0.1, 0}, 0.05, 3000);   // beside the rim of the view
  picture.disc({0, 1, -0.8}, 0.05, 1900);  // too dim
  std::vector<int> of;
  const auto sources = glareSources(picture.image, kEye, {}, &of);
  ASSERT_EQ(sources.size(), 3u);
  EXPECT_NEAR(sources[0].luminance, 30000, 1);
  EXPECT_NEAR(sources[1].luminance, 6000, 60);
  EXPECT_NEAR(sources[2].luminance, 3000, 1);
  EXPECT_EQ(of[kSize / 2 * kSize + kSize / 2], -1);
  const Vec2 high = fisheyePlace(kEye, {0, 1, 0.9});
  const auto pixel = static_cast<std::size_t>((1 - high.y) / 2 * kSize) * kSize + kSize / 2;
  EXPECT_EQ(of[pixel], 0);
  EXPECT_EQ(glareSources(picture.image, kEye, {.withinAngle = 0.05}).size(), 4u);
}

TEST(GlareSources, NoneInTheDark) { EXPECT_TRUE(glareSources(Picture().image, kEye).empty()); }

}  // namespace
}  // namespace deltalux
