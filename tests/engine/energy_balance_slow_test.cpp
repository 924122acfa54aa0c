// The energy of our large scenes, at the default error.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>

#include "support/residue.hpp"

namespace deltalux {
namespace {

double residueOf(const char* name) {
  Scene scene = loadScene({std::string(DELTALUX_SOURCE_DIR "/scenes/") + name}).scene;
  return test::residue(Engine(std::move(scene), {}).solve().energy);
}

/// What is left is noise of rows, and of particles that feed each other what is damped (spread_levels.hpp).
TEST(EnergyOfLargeScenes, LodgeInTheMorning) { EXPECT_NEAR(residueOf("lodge/morning.rad"), 0, 1e-3); }
TEST(EnergyOfLargeScenes, LodgeAtNight) { EXPECT_NEAR(residueOf("lodge/night.rad"), 0, 1e-3); }
TEST(EnergyOfLargeScenes, Street) { EXPECT_NEAR(residueOf("street/day.rad"), 0, 1e-3); }
/// Its leaves of trees lie every way: each once was lit by its own other side.
TEST(EnergyOfLargeScenes, StreetAtNight) { EXPECT_NEAR(residueOf("street/night.rad"), 0, 1e-3); }

}  // namespace
}  // namespace deltalux
