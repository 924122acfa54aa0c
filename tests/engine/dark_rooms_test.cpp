// Rooms that light hardly reaches (tests/assets/dark) against the reference integrator.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "support/reference_values.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// Of its meters whether none is off by more than that.
void expectAgreement(const std::string& scene, double tolerance) {
  const Engine engine =
      solved(loadScene({std::string(DELTALUX_SOURCE_DIR) + "/tests/assets/dark/" + scene + ".rad"}).scene, 0.05);
  const std::vector<ReferenceValue> meters =
      readReferenceValues(std::string(DELTALUX_SOURCE_DIR) + "/tests/assets/dark/" + scene + "-reference.csv");
  ASSERT_FALSE(meters.empty());
  std::vector<ProbePoint> points;
  for (const ReferenceValue& m : meters) points.push_back(m.point);
  const std::vector<ProbeResult> found = measure(engine, points);
  for (std::size_t i = 0; i < meters.size(); ++i)
    EXPECT_NEAR(gray(found[i].irradiance) / gray(meters[i].irradiance), 1, tolerance)
        << scene << ", " << meters[i].region;
}

TEST(DarkRooms, ADoorAjarLetsInWhatItShould) { expectAgreement("door-ajar", 0.12); }
TEST(DarkRooms, TwoPanesLetLightIn) { expectAgreement("double-window", 0.06); }
TEST(DarkRooms, AnOpalRooflightIsAllTheLightThereIs) { expectAgreement("opal-rooflight", 0.06); }
TEST(DarkRooms, ThePoolOfANarrowSpotLightsItsRoom) { expectAgreement("narrow-spot", 0.08); }
TEST(DarkRooms, AGapOfAMillimetreIsNoMatterOfChance) { expectAgreement("door-gap", 0.45); }
TEST(DarkRooms, ASlotOfAMillimetreIsNoMatterOfChance) { expectAgreement("shutter-slot", 0.45); }

}  // namespace
}  // namespace deltalux
