#include <deltalux/glare.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace deltalux {
namespace {

constexpr double kDegree = kPi / 180;
const Eye kEye{{0, 0, 1.2}, {0, 1, 0}, {0, 0, 1}};

/// sigma from the line of sight, tau from the vertical, towards the right.
Vec3 at(double sigma, double tau) {
  const double s = std::sin(sigma * kDegree);
  return {s * std::sin(tau * kDegree), std::cos(sigma * kDegree), s * std::cos(tau * kDegree)};
}

TEST(PositionIndex, IsOneOnTheLineOfSight) { EXPECT_NEAR(positionIndex(kEye, {0, 1, 0}), 1, 1e-9); }

TEST(PositionIndex, IsGuthsAboveTheLineOfSight) {
  // ln P = (35.2 - 1.22) 0.03 + 21e-5 900; (35.2 - 28.7001 - 2.5e-9) 0.03 + (21 + 24.0003 - 24.0003) 1e-5 900.
  EXPECT_NEAR(positionIndex(kEye, at(30, 0)), std::exp(1.0194 + 0.189), 1e-4);
  EXPECT_NEAR(positionIndex(kEye, at(30, 90)), std::exp(0.194997 + 0.189), 1e-4);
  // tau 45: e^-10 is 4.54e-5; 35.2 - 14.35005 - 5.5e-5 = 20.84989; 21 + 12.00015 - 6.000075 = 27.000075.
  EXPECT_NEAR(positionIndex(kEye, at(20, 45)), std::exp(0.4169978 + 0.1080003), 1e-4);
}

TEST(PositionIndex, IsTheSameLeftAndRightAndDependsNotOnHowTheEyeIsSaid) {
  Vec3 left = at(40, 60);
  left.x = -left.x;
  EXPECT_NEAR(positionIndex(kEye, at(40, 60)), positionIndex(kEye, left), 1e-12);
  const Eye other{{5, 5, 5}, {0, 3, 0}, {0, 0.8, 2}};
  EXPECT_NEAR(positionIndex(kEye, at(40, 60)), positionIndex(other, 7.0 * at(40, 60)), 1e-9);
}

TEST(PositionIndex, IsIwatasAndTokurasBelow) {
  EXPECT_NEAR(positionIndex(kEye, {0, 1, -0.5}), 1.4, 1e-9);
  EXPECT_NEAR(positionIndex(kEye, {0.3, 1, -0.4}), 1.4, 1e-9);
  EXPECT_NEAR(positionIndex(kEye, {0, 1, -1}), 2.2, 1e-9);
}

TEST(Ratings, AreTheStandardsSums) {
  const std::vector<GlareSource> two{{{0, 1, 0}, 3000, 0.02, 2}, {{0, 1, 0}, 5000, 0.01, 4}};
  // 0.25 / 40 (9e6 0.02 / 4 + 25e6 0.01 / 16) = 378.90625.
  EXPECT_NEAR(unifiedGlareRating(two, 40), 8 * std::log10(378.90625), 1e-9);
  EXPECT_EQ(unifiedGlareRating({}, 40), -kInfinity);
  EXPECT_EQ(unifiedGlareRating(two, 0), kInfinity);
  EXPECT_NEAR(daylightGlareProbability({}, 4000), 5.87e-5 * 4000 + 0.16, 1e-12);
  EXPECT_NEAR(daylightGlareProbability(two, 2000),
              5.87e-5 * 2000 + 9.18e-2 * std::log10(1 + 60625 / std::pow(2000, 1.87)) + 0.16, 1e-12);
  // Of 100 lux people do not complain: 0.16587 e^-1.6 / (1 + e^-1.6).
  EXPECT_NEAR(daylightGlareProbability({}, 100), 0.16587 * 0.2018965 / 1.2018965, 1e-6);
  EXPECT_EQ(daylightGlareProbability({}, 0), 0);
}

TEST(Fisheye, PlacesAndDirectionsAreInverse) {
  const Eye eye{{1, 2, 3}, {0.3, -1, 0.2}, {0, 0, 1}};
  for (const Vec2 p : {Vec2(0, 0), Vec2(0.3, -0.5), Vec2(-0.9, 0.1), Vec2(0, 1)}) {
    const auto d = fisheyeDirection(eye, p.x, p.y);
    ASSERT_TRUE(d);
    EXPECT_NEAR(glm::length(fisheyePlace(eye, *d) - p), 0, 1e-6);
    EXPECT_NEAR(std::acos(glm::dot(*d, glm::normalize(eye.direction))), glm::length(p) * kPi / 2, 1e-6);
  }
  EXPECT_FALSE(fisheyeDirection(eye, 0.8, 0.8));
}

}  // namespace
}  // namespace deltalux
