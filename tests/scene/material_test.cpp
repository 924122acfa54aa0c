#include <gtest/gtest.h>

#include <deltalux/light.hpp>
#include <deltalux/material.hpp>

namespace deltalux {
namespace {

double cosOf(double degrees) { return std::cos(degrees * kPi / 180); }

// CIE 171 case 5.5: directional transmittance of clear glass, n = 1.52, no absorption.
TEST(ThinGlass, TransmittanceOfCie171Case55) {
  const double angles[] = {0, 30, 50, 60, 70};
  const double expected[] = {.9183, .9160, .8912, .8435, .7247};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(transmittance(ThinGlass{}, cosOf(angles[i])).g, expected[i], 5e-5);
}

TEST(ThinGlass, ClearPaneLosesNothing) {
  for (double degrees = 0; degrees < 90; degrees += 3) {
    const Rgb sum = transmittance(ThinGlass{}, cosOf(degrees)) + reflectance(ThinGlass{}, cosOf(degrees));
    EXPECT_NEAR(sum.r, 1.0, 1e-6) << degrees;
  }
}

TEST(ThinGlass, AbsorptionFollowsThePathInside) {
  const ThinGlass tinted{{0.9f, 0.5f, 0.0f}, 1.52f};
  const Rgb through = transmittance(tinted, 1.0);
  // At normal incidence r = ((n-1)/(n+1))^2 and the sum over internal reflections is a geometric series.
  const double r = std::pow(0.52 / 2.52, 2), a = 0.5;
  EXPECT_NEAR(through.g, (1 - r) * (1 - r) * a / (1 - r * r * a * a), 1e-6);
  EXPECT_EQ(through.b, 0.0f);
  EXPECT_LT(transmittance(tinted, 0.3).g, through.g);
  EXPECT_NEAR(reflectance(tinted, 1.0).b, r, 1e-6);  // the front face alone
}

TEST(Fresnel, KnownAngles) {
  EXPECT_NEAR(fresnelDielectric(1.0, 1.5), 0.04, 1e-12);
  EXPECT_NEAR(fresnelDielectric(0.0, 1.5), 1.0, 1e-12);
  // At Brewster's angle only the s-polarised half reflects: 0.5 cos^2(2 theta).
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(fresnelDielectric(std::cos(brewster), 1.5), 0.5 * std::pow(std::cos(2 * brewster), 2), 1e-12);
  // Total internal reflection beyond 41.8 degrees; reversible below.
  EXPECT_EQ(fresnelDielectric(cosOf(45), 1 / 1.5), 1.0);
  const double inside = std::asin(std::sin(0.7) / 1.5);
  EXPECT_NEAR(fresnelDielectric(std::cos(inside), 1 / 1.5), fresnelDielectric(std::cos(0.7), 1.5), 1e-12);
}

TEST(Material, ToldApart) {
  Material plastic{"plastic", Opaque{.diffuse = Rgb(0.5f), .diffuseTexture = {}, .specular = {}}, {}};
  EXPECT_EQ(diffuseReflectance(plastic, true), Rgb(0.5f));
  EXPECT_FALSE(isSpecular(plastic));
  std::get<Opaque>(plastic.surface).specular.reflectance = Rgb(0.02f);
  EXPECT_TRUE(isSpecular(plastic));
  const Material trans{
      "trans",
      Trans{.diffuseReflectance = Rgb(0.2f), .diffuseTransmittance = Rgb(0.3f), .reflection = {}, .transmission = {}},
      {}};
  EXPECT_EQ(diffuseReflectance(trans, false), Rgb(0.2f));
  EXPECT_EQ(diffuseTransmittance(trans), Rgb(0.3f));
  EXPECT_TRUE(isPane({"pane", ThinGlass{}, {}}));
  EXPECT_EQ(diffuseReflectance({"mirror", Mirror{Rgb(0.9f)}, {}}, true), Rgb(0.0f));
}

TEST(Material, CoverageScalesTheSurfaceAndPassesTheRest) {
  Material curtain{"curtain", Opaque{Rgb(0.8f), {}, {Rgb(0.1f), 0.2f}}, {}, 0.25f, Rgb(1.0f, 0.5f, 0.0f)};
  EXPECT_EQ(diffuseReflectance(curtain, true), Rgb(0.2f));
  EXPECT_EQ(diffuseReflectance(curtain, false), Rgb(0.2f));
  for (const double cosine : {1.0, 0.5, 0.01})
    EXPECT_EQ(straightTransmittance(curtain, cosine), Rgb(0.75f, 0.375f, 0.0f)) << "the same at every angle";
  EXPECT_TRUE(passesStraight(curtain));
  EXPECT_FALSE(isClear(curtain));
  EXPECT_TRUE(isSpecular(curtain));
  curtain.coverage = 1;
  EXPECT_FALSE(passesStraight(curtain));
  EXPECT_EQ(straightTransmittance(curtain, 1.0), Rgb(0.0f));
  curtain.coverage = 0;
  EXPECT_TRUE(isPane(curtain)) << "nothing is there";
  EXPECT_FALSE(isSpecular(curtain));
  const Material trans{"trans", Trans{Rgb(0.2f), Rgb(0.4f), {}, {Rgb(0.3f), 0.0f}}, {}, 0.5f};
  EXPECT_EQ(diffuseTransmittance(trans), Rgb(0.2f));
  EXPECT_EQ(straightTransmittance(trans, 1.0), Rgb(0.5f));
  const Material glass{"glass", ThinGlass{}, {}, 0.5f};
  EXPECT_NEAR(straightTransmittance(glass, 0.3).g, 0.5 + 0.5 * transmittance(ThinGlass{}, 0.3).g, 1e-6);
}

TEST(SpotLight, FalloffOfKhrLightsPunctual) {
  const SpotLight spot{Vec3(0), {0, 0, -1}, Rgb(8.0f), std::cos(0.2), std::cos(0.6)};
  EXPECT_EQ(radiantIntensity(spot, {0, 0, -1}).r, 8.0f);
  EXPECT_EQ(radiantIntensity(spot, {0, 0, 1}).r, 0.0f);
  const double c = std::cos(0.4);
  const double expected = 8 * std::pow((c - std::cos(0.6)) / (std::cos(0.2) - std::cos(0.6)), 2);
  EXPECT_NEAR(radiantIntensity(spot, {std::sin(0.4), 0, -c}).r, expected, 1e-5);
}

TEST(SunLight, SolidAngleOfASmallDisc) {
  const SunLight sun{{0, 0, 1}, 0.2665 * kPi / 180, Rgb(1.0f)};
  EXPECT_NEAR(solidAngle(sun), 2 * kPi * (1 - std::cos(sun.angularRadius)), 1e-11);
  EXPECT_NEAR(solidAngle(sun), kPi * sun.angularRadius * sun.angularRadius, 1e-9);
}

}  // namespace
}  // namespace deltalux
