#include <gtest/gtest.h>
#include <deltalux/light.hpp>

namespace deltalux {
namespace {

Vec3 direction(double zenithAngle, double azimuth) {
  return {std::sin(zenithAngle) * std::cos(azimuth), std::sin(zenithAngle) * std::sin(azimuth), std::cos(zenithAngle)};
}

/// Horizontal irradiance of the upper hemisphere: midpoint rule in (cos^2, azimuth), where the cosine is uniform.
double horizontalIrradiance(const DomeLight& dome) {
  constexpr int kSteps = 400;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosZenith = std::sqrt((i + 0.5) / kSteps);
    for (int j = 0; j < kSteps; ++j) {
      sum += skyRadiance(dome, direction(std::acos(cosZenith), 2 * kPi * (j + 0.5) / kSteps)).r;
    }
  }
  return kPi * sum / (kSteps * kSteps);
}

DomeLight dome(decltype(DomeLight::distribution) distribution) {
  DomeLight light;
  light.distribution = distribution;
  return light;
}

TEST(SkyRadiance, IsZeroOutsideTheCone) {
  DomeLight light = dome(UniformSky{2.0});
  light.scale = {1, 2, 3};
  EXPECT_EQ(skyRadiance(light, Vec3(0, 0, 1)), Rgb(2, 4, 6));
  EXPECT_EQ(skyRadiance(light, Vec3(1, 0, 0)), Rgb(2, 4, 6));
  EXPECT_EQ(skyRadiance(light, Vec3(0, 0, -1)), Rgb(0.0f));
  light.halfAngle = 0.1;
  EXPECT_EQ(skyRadiance(light, direction(0.11, 1)), Rgb(0.0f));
}

TEST(CieSky, IsTheZenithRadianceAtTheZenith) {
  for (int type = 1; type <= 15; ++type) {
    const DomeLight light = dome(CieSky{type, 7.0, 0.5, direction(0.9, 0.3)});
    EXPECT_FLOAT_EQ(skyRadiance(light, Vec3(0, 0, 1)).r, 7.0f) << type;
    for (double zenithAngle = 0.05; zenithAngle < 1.55; zenithAngle += 0.1) {
      EXPECT_GT(skyRadiance(light, direction(zenithAngle, 2.0)).r, 0.0f) << type;
    }
  }
}

TEST(CieSky, Type5IsUniformAndType1IsNearTheOldOvercastSky) {
  EXPECT_NEAR(horizontalIrradiance(dome(CieSky{5, 1.0, 0, direction(1, 0)})), kPi, 1e-5);
  // The old overcast sky's horizontal irradiance is 7 pi / 9; the exponential gradation is a fit to it.
  EXPECT_NEAR(horizontalIrradiance(dome(CieSky{1, 1.0, 0, direction(1, 0)})), 7 * kPi / 9, 0.02 * kPi);
}

TEST(RadianceSky, OvercastSkyHasTheClosedFormIrradiance) {
  // Quadrature of (1 + 2 cos)/3 blended with the ground at the horizon; without the blend 7 pi / 9.
  const RadianceSky sky{RadianceSky::Kind::Overcast, 1.0, 0.0, 1.0, Vec3(0, 0, 1)};
  EXPECT_NEAR(horizontalIrradiance(dome(sky)), 7 * kPi / 9, 0.01 * kPi);
  EXPECT_NEAR(skyRadiance(dome(sky), Vec3(0, 0, 1)).r, 1.0, 1e-6);
}

TEST(RadianceSky, ClearSkyIsCieType12AboveTheHorizon) {
  // Both are Kittler's clear sky; constants are rounded differently, and the blend with the ground reaches a few
  // degrees.
  const Vec3 sun = direction(glm::radians(60.0), 0.4);
  const double norm = 0.274 * (0.91 + 10 * std::exp(-3 * glm::radians(60.0)) + 0.45 * 0.25);
  const DomeLight radiance = dome(RadianceSky{RadianceSky::Kind::Clear, 10.0, 0.0, norm, sun});
  const DomeLight cie = dome(CieSky{12, 10.0, 0.0, sun});
  for (double zenithAngle = 0.1; zenithAngle < 1.2; zenithAngle += 0.2) {
    for (double azimuth = 0; azimuth < 6; azimuth += 0.7) {
      const Vec3 towards = direction(zenithAngle, azimuth);
      EXPECT_NEAR(skyRadiance(radiance, towards).r / skyRadiance(cie, towards).r, 1, 2e-3);
    }
  }
}

TEST(RadianceSky, BelowTheHorizonIsTheGround) {
  DomeLight light = dome(RadianceSky{RadianceSky::Kind::Clear, 10.0, 3.0, 1.0, direction(0.5, 0)});
  light.axis = {0, 0, -1};
  EXPECT_NEAR(skyRadiance(light, direction(2.2, 0.1)).r, 3.0, 1e-3);
  EXPECT_NEAR(skyRadiance(light, Vec3(0, 0, -1)).r, 3.0, 1e-6);
}

TEST(SkyRadiance, FollowsItsOwnZenith) {
  DomeLight tilted = dome(RadianceSky{RadianceSky::Kind::Overcast, 1.0, 0.0, 1.0, Vec3(0, 0, 1)});
  tilted.up = tilted.axis = {1, 0, 0};
  EXPECT_NEAR(skyRadiance(tilted, Vec3(1, 0, 0)).r, 1.0, 1e-6);
}

}  // namespace
}  // namespace deltalux
