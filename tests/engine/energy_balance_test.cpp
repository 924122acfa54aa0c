// What lights bring is absorbed or escapes; each is measured on its own, so what is missing is the solution's error.
#include "engine/energy_balance.hpp"

#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>

#include "support/rooms.hpp"

namespace deltalux {
namespace {

EnergyLedger balanceOf(Scene scene, double error = 0.05) {
  SolveSettings settings;
  settings.error = error;
  return Engine(std::move(scene), settings).solve().energy;
}

double residue(const EnergyLedger& l) {
  return (*l.emittedW - *l.absorbedW - *l.escapedW - *l.unsettledW) / *l.emittedW;
}

Scene bundled(const char* name) { return loadScene({std::string(DELTALUX_SOURCE_DIR "/scenes/") + name}).scene; }

TEST(EnergyBalance, ClosedRoomWithMirrorAndGlass) {
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "wall", test::lambert(0.5f)), {0, 0, 0}, {1, 1.5, 0.8}, true);
  test::addBox(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(0.8f)}), {0.2, 0.3, 0.1}, {0.5, 0.6, 0.5}, false);
  test::addShape(scene, test::addMaterial(scene, "glass", Dielectric{Rgb(1.0f), 1.5f}), Sphere{{0.6, 1.1, 0.3}, 0.2});
  test::addLight(scene, PointLight{{0.7, 0.7, 0.6}, Rgb(1.0f)});
  const EnergyLedger l = balanceOf(std::move(scene), 0.02);
  EXPECT_NEAR(*l.emittedW, 4 * kPi, 0.005 * 4 * kPi);
  EXPECT_EQ(*l.escapedW, 0);
  EXPECT_NEAR(residue(l), 0, 0.005);
}

TEST(EnergyBalance, OpenScenes) {
  EXPECT_NEAR(residue(balanceOf(bundled("nasty/nested_glass.rad"))), 0, 0.005);
  EXPECT_NEAR(residue(balanceOf(bundled("nasty/mirror_corridor.rad"))), 0, 0.005);
  const EnergyLedger cornell = balanceOf(bundled("cornell-caustic/cornell-caustic.rad"));
  EXPECT_NEAR(residue(cornell), 0, 0.01);
  EXPECT_GT(*cornell.escapedW, 0.1 * *cornell.emittedW);
}

/// What a pane reflects is particles' light, 1.5 % of all here; what it passes arrives behind it.
TEST(EnergyBalance, Panes) {
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "wall", test::lambert(0.2f)), {0, 0, 0}, {1, 1, 1}, true);
  const MaterialId pane = test::addMaterial(scene, "pane", ThinGlass{Rgb(0.8f), 1.52f});
  test::addPolygon(scene, pane, {{0.2, 0.5, 0.2}, {0.8, 0.5, 0.2}, {0.8, 0.5, 0.8}, {0.2, 0.5, 0.8}});
  test::addLight(scene, PointLight{{0.5, 0.2, 0.5}, Rgb(1.0f)});
  const EnergyLedger l = balanceOf(std::move(scene), 0.02);
  EXPECT_LT(*l.emittedW, 0.98 * 4 * kPi);
  EXPECT_NEAR(residue(l), 0, 0.004);
}

}  // namespace
}  // namespace deltalux
