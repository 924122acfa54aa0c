// The energy of our large scenes, at the default error.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>

#include "support/residue.hpp"

namespace deltalux {
namespace {

double residueOf(const char* name, double error = 0.05) {
  Scene scene = loadScene({std::string(DELTALUX_SOURCE_DIR "/scenes/") + name}).scene;
  return test::residue(Engine(std::move(scene), {.error = error}).solve().energy);
}

/// What is left is noise of rows, and of particles that feed each other what is damped (spread_levels.hpp).
TEST(EnergyOfLargeScenes, LodgeInTheMorning) { EXPECT_NEAR(residueOf("lodge/morning.rad"), 0, 1e-3); }
/// Rows of one mesh vary by 0.1 to 0.16 % of its light together: three meshes tell more.
TEST(EnergyOfLargeScenes, LodgeAtNight) {
  double mean = 0;
  for (const double error : {0.045, 0.05, 0.055}) {
    const double residue = residueOf("lodge/night.rad", error);
    EXPECT_NEAR(residue, 0, 3e-3);
    mean += residue / 3;
  }
  EXPECT_NEAR(mean, 0, 1e-3);
}
TEST(EnergyOfLargeScenes, Street) { EXPECT_NEAR(residueOf("street/day.rad"), 0, 1e-3); }
/// Its leaves of trees lie every way: each once was lit by its own other side.
TEST(EnergyOfLargeScenes, StreetAtNight) { EXPECT_NEAR(residueOf("street/night.rad"), 0, 1e-3); }

}  // namespace
}  // namespace deltalux
