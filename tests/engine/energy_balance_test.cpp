// What lights bring is absorbed or escapes; each is measured on its own, so what is missing is the solution's error.
#include "engine/energy_balance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>

#include "hierarchy/side_locator.hpp"
#include "solution/solution.hpp"
#include "support/residue.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using test::residue;

EnergyLedger balanceOf(Scene scene, double error = 0.05) {
  SolveSettings settings;
  settings.error = error;
  return Engine(std::move(scene), settings).solve().energy;
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

/// What solutions of our scenes lose or gain at the default error is a thousandth of all light at most; what is left is
/// noise of lines and particles (most of it in thin, whose light goes round four times; of parallel plates, whose few
/// lines tell how much escapes to a third of a per cent, at a smaller error).
struct Reached {
  const char* scene;
  double residue = 1e-3, error = 0.05;
};

class EnergyBalances : public testing::TestWithParam<Reached> {};

TEST_P(EnergyBalances, Close) {
  EXPECT_NEAR(residue(balanceOf(bundled(GetParam().scene), GetParam().error)), 0, GetParam().residue);
}

INSTANTIATE_TEST_SUITE_P(Bundled, EnergyBalances,
                         testing::Values(Reached{"furnace/furnace.gltf"}, Reached{"nasty/nested_glass.rad"},
                                         Reached{"nasty/outlines.rad"}, Reached{"nasty/slivers.rad"},
                                         Reached{"nasty/touching.rad"}, Reached{"plates/perpendicular.rad"},
                                         Reached{"nasty/mirror_corridor.rad"}, Reached{"nasty/sealed.rad"},
                                         Reached{"nasty/thin.rad", 1.5e-3}, Reached{"plates/parallel.rad", 1e-3, 0.01},
                                         Reached{"cornell/cornell.rad"}, Reached{"cornell-caustic/cornell-caustic.rad"},
                                         Reached{"ring/ring.rad"}, Reached{"nasty/scales.rad"},
                                         Reached{"nasty/coplanar.rad"}, Reached{"nasty/far_away.rad"}),
                         [](const auto& reached) {
                           std::string name = reached.param.scene;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

/// A gap between two shells that stand on a table is closed: the table under it is dark, and nothing lands in it.
TEST(EnergyBalance, NothingLeaksIntoAClosedGap) {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 100000, settings.causticTextures = false;
  settings.method = SolveMethod::Paper;  // over lines all sides have elements
  Engine engine(bundled("ring/ring.rad"), settings);
  engine.solve();
  const Solution& s = engine.solution().get();
  const hierarchy::SideLocator locator(s.elements, s.scene);
  int shells = 0;
  for (std::size_t i = 0; i < s.scene.primitives.size(); ++i) {
    const std::string& name = s.scene.objects[s.scene.primitives[i].object.index()].name;
    if (name != "ring.inside" && name != "ring.outside") continue;
    ++shells;
    EXPECT_TRUE(locator.side(PrimitiveId(i), 0, true).valid()) << name;
    EXPECT_FALSE(locator.side(PrimitiveId(i), 0, false).valid()) << name;
  }
  EXPECT_EQ(shells, 2);
}

/// Small glossy things close together, few particles: by chance a thing may be found to get more from another than all
/// that it could get. Sent back and forth such light would grow without end; no surface is brighter than what lights
/// bring to the brightest place, reflected for ever by the best reflector.
TEST(EnergyBalance, GlossyThingsDoNotFeedEachOther) {
  constexpr float kRed = 0.85f, kGloss = 0.1f;
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "wall", test::lambert(0.5f)), {0, 0, 0}, {2, 2, 2}, true);
  const MaterialId book = test::addMaterial(scene, "book", Opaque{Rgb(kRed, 0.1f, 0.1f), {}, {Rgb(kGloss), 0.1f}});
  for (int i = 0; i < 24; ++i) {
    const double x = 0.5 + 0.03 * i;
    test::addBox(scene, book, {x, 0.8, 0.4}, {x + 0.025, 1.0, 0.65 + 0.01 * (i % 5)}, false);
  }
  test::addLight(scene, PointLight{{0.8, 0.4, 1.6}, Rgb(10.0f)});
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 20000, settings.causticTextures = false;
  Engine engine(std::move(scene), settings);
  const EnergyLedger ledger = engine.solve().energy;
  const hierarchy::Elements& elements = engine.solution().get().elements;
  float lit = 0, most = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const hierarchy::ElementLight& l = elements.radiometry[i];
    lit = std::max(lit, l.direct.r), most = std::max(most, (l.direct + l.indirect + l.particle).r);
  }
  EXPECT_LT(most, lit / (1 - kRed - kGloss));
  EXPECT_NEAR(residue(ledger), 0, 0.02);
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
