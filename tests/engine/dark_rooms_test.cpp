// Rooms that light hardly reaches (tests/assets/dark) against the reference integrator.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "support/solved_by_lines.hpp"

namespace deltalux {
namespace {

using namespace test;

struct Meter {
  std::string name;
  ProbePoint point;
  double E = 0;  // [W/m2, gray]
};

/// Of columns name, x, y, z, nx, ny, nz, E_r, E_g, E_b.
std::vector<Meter> referenceOf(const std::string& scene) {
  std::ifstream in(std::string(DELTALUX_SOURCE_DIR) + "/tests/assets/dark/" + scene + "-reference.csv");
  std::vector<Meter> meters;
  std::string row;
  std::getline(in, row);
  while (std::getline(in, row)) {
    std::replace(row.begin(), row.end(), ',', ' ');
    std::istringstream fields(row);
    Meter m;
    Vec3& p = m.point.position;
    Vec3& n = m.point.normal;
    glm::dvec3 E(0);
    fields >> m.name >> p.x >> p.y >> p.z >> n.x >> n.y >> n.z >> E.r >> E.g >> E.b;
    m.E = gray(E), meters.push_back(m);
  }
  return meters;
}

/// Of its meters whether none is off by more than that.
void expectAgreement(const std::string& scene, double tolerance) {
  const Engine engine =
      solvedByLines(loadScene({std::string(DELTALUX_SOURCE_DIR) + "/tests/assets/dark/" + scene + ".rad"}).scene);
  const std::vector<Meter> meters = referenceOf(scene);
  ASSERT_FALSE(meters.empty());
  std::vector<ProbePoint> points;
  for (const Meter& m : meters) points.push_back(m.point);
  const std::vector<ProbeResult> found = measure(engine, points);
  for (std::size_t i = 0; i < meters.size(); ++i)
    EXPECT_NEAR(gray(found[i].irradiance) / meters[i].E, 1, tolerance) << scene << ", " << meters[i].name;
}

TEST(DarkRooms, ADoorAjarLetsInWhatItShould) { expectAgreement("door-ajar", 0.12); }
TEST(DarkRooms, TwoPanesLetLightIn) { expectAgreement("double-window", 0.06); }
TEST(DarkRooms, AnOpalRooflightIsAllTheLightThereIs) { expectAgreement("opal-rooflight", 0.06); }
TEST(DarkRooms, ThePoolOfANarrowSpotLightsItsRoom) { expectAgreement("narrow-spot", 0.08); }
TEST(DarkRooms, AGapOfAMillimetreIsNoMatterOfChance) { expectAgreement("door-gap", 0.45); }
TEST(DarkRooms, ASlotOfAMillimetreIsNoMatterOfChance) { expectAgreement("shutter-slot", 0.45); }

}  // namespace
}  // namespace deltalux
