// Which points read a surface, and which are meters in the air.
#include <gtest/gtest.h>

#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A black table top over a wide black floor, under a sky that is brighter by far than the floor.
Scene tableOutdoors(double unit) {
  Scene scene;
  scene.metresPerUnit = unit;
  const MaterialId black = addMaterial(scene, "black", lambert(0)), grey = addMaterial(scene, "grey", lambert(0.5f));
  addPolygon(scene, grey, {{-1000, -1000, 0}, {1000, -1000, 0}, {1000, 1000, 0}, {-1000, 1000, 0}});
  addPolygon(scene, black, {{-1, -1, 0.7}, {1, -1, 0.7}, {1, 1, 0.7}, {-1, 1, 0.7}});
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(1.0f), UniformSky{1}, {0, 0, 1}});
  return scene;
}

TEST(OnSurface, IsAMatterOfMillimetresNotOfTheScenesSize) {
  const Engine engine = solved(tableOutdoors(1), 0.1);
  const auto E = measure(engine, {{{0.2, 0.3, 0.75}, {0, 0, 1}},    // in the air above the table
                                  {{0.2, 0.3, 0.7005}, {0, 0, 1}},  // on it
                                  {{0.2, 0.3, 0.65}, {0, 0, 1}},    // below it: it is black
                                  {{0.2, 0.3, 0.65}, {0, 0, -1}},   // the same, towards the floor
                                  {{5, 5, 0.02}, {0, 0, -1}},       // two centimetres above the floor, towards it
                                  {{5, 5, 0.02}, {0, 0, 1}}});
  EXPECT_NEAR(E[0].irradiance.g, kPi, 0.02 * kPi);
  EXPECT_NEAR(E[1].irradiance.g, kPi, 0.02 * kPi);
  EXPECT_LT(E[2].irradiance.g, 0.01 * kPi) << "the sky is seen along the edges alone";
  EXPECT_GT(E[3].irradiance.g, 0.1);
  EXPECT_NEAR(E[4].irradiance.g, 0.5 * kPi, 0.03 * kPi);
  EXPECT_NEAR(E[5].irradiance.g, kPi, 0.03 * kPi);
}

TEST(OnSurface, MillimetresAreMetresOfTheScenesUnit) {
  const Engine engine = solved(tableOutdoors(0.001), 0.2);  // in millimetres
  const auto E = measure(engine, {{{0.2, 0.3, 0.5}, {0, 0, 1}}, {{5, 5, 2.5}, {0, 0, -1}}});
  EXPECT_NEAR(E[0].irradiance.g, kPi, 0.05 * kPi) << "on the table, which is 0.2 mm above it";
  EXPECT_GT(E[1].irradiance.g, 0.4 * kPi) << "2.5 mm above the floor, towards it";
}

}  // namespace
}  // namespace deltalux
