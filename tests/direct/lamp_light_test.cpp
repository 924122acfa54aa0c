#include "direct/lamp_light.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace deltalux {
namespace {

using direct::LampLight;

TEST(LampLight, DimmedIsTheWeightedSum) {
  const std::vector<LampLight> lamps{{LightId(0), Rgb(1, 2, 3), 0.25f, 0}, {LightId(2), Rgb(4.0f), 1.0f, 0}};
  const std::vector<Rgb> dimming{Rgb(0.5f, 0.25f, 1), Rgb(7.0f), Rgb(0.5f)};
  const direct::DimmedLight sum = direct::dimmed(lamps, dimming);
  EXPECT_EQ(sum.E, Rgb(2.5f, 2.5f, 5));
  const double factor = double(gray(Rgb(0.5f, 0.5f, 3))) / gray(Rgb(1, 2, 3));
  EXPECT_NEAR(sum.deviation, std::sqrt(0.25 * factor * factor + 0.25), 1e-6);
}

TEST(LampLight, OffBringsNothing) {
  const std::vector<LampLight> lamps{{LightId(0), Rgb(1.0f), 0.25f, 0}};
  const std::vector<Rgb> off{Rgb(0.0f)};
  EXPECT_EQ(direct::dimmed(lamps, off).E, Rgb(0.0f));
  EXPECT_EQ(direct::dimmed(lamps, off).deviation, 0.0f);
}

TEST(LampLight, DrawnIsTheMeanOfEachLamp) {
  std::vector<LampLight> all{{LightId(9), Rgb(1.0f), 0, 0}};
  direct::addDrawn(all, {{LightId(4), Rgb(2.0f), 0, 0}, {LightId(1), Rgb(1.0f), 0, 0}, {LightId(4), Rgb(5.0f), 0, 0}},
                   4, 0.8);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].lamp, LightId(1));
  EXPECT_EQ(all[1].E, Rgb(0.25f));
  EXPECT_EQ(all[2].lamp, LightId(4));
  EXPECT_EQ(all[2].E, Rgb(1.75f));
  EXPECT_NEAR(all[1].variance, 0.1, 1e-6);  // shares of .8, as of the light
  EXPECT_NEAR(all[2].variance, 0.7, 1e-6);
}

TEST(LampLight, NothingDrawnAddsNothing) {
  std::vector<LampLight> all;
  direct::addDrawn(all, {}, 4, 0);
  EXPECT_TRUE(all.empty());
}

}  // namespace
}  // namespace deltalux
