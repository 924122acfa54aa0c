// The tree over lamps: bounds that hold, cuts that leave none out, draws by their chance.
#include "direct/lamp_tree.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.hpp"
#include "direct/lamps.hpp"
#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;
using direct::LampTree;

Vec3 pointIn(Rng& random, double size) {
  const double x = random.uniform(), y = random.uniform(), z = random.uniform();
  return size * (2.0 * Vec3(x, y, z) - 1.0);
}

/// Points, spots, downlights and globes, bright and faint.
Scene lampsOfAllKinds(int count) {
  Scene scene;
  Rng random(7);
  for (int i = 0; i < count; ++i) {
    const Vec3 at = pointIn(random, 10), towards = glm::normalize(pointIn(random, 1) + Vec3(0, 0, 0.01));
    const auto bright = static_cast<float>(std::exp2(8 * random.uniform()));
    if (i % 4 == 0) {
      addLight(scene, PointLight{at, Rgb(bright)});
    } else if (i % 4 == 1) {
      SpotLight spot;
      spot.position = at, spot.direction = towards, spot.intensity = Rgb(bright);
      spot.cosInner = std::cos(0.3), spot.cosOuter = std::cos(0.5);
      addLight(scene, spot);
    } else if (i % 4 == 2) {
      const Frame frame(towards);
      const MaterialId m = addMaterial(scene, "disc", lambert(0), Emission{Rgb(bright), false, std::nullopt});
      const auto corner = [&](double x, double y) { return at + frame.toWorld(0.3 * Vec3(x, y, 0)); };
      addPolygon(scene, m, {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)});
    } else {
      const MaterialId m = addMaterial(scene, "globe", lambert(0), Emission{Rgb(bright), false, std::nullopt});
      scene.primitives.push_back({Sphere{at, 0.2}, m, ObjectId()});
    }
  }
  addAreaLights(scene);
  return scene;
}

hierarchy::ElementGeometry patchOf(Rng& random) {
  hierarchy::ElementGeometry g;
  g.center = Vec3f(pointIn(random, 12));
  g.normal = Vec3f(glm::normalize(pointIn(random, 1) + Vec3(0, 0, 0.01)));
  g.radius = static_cast<float>(std::exp2(-6 + 8 * random.uniform()));
  const double cone = random.uniform();
  g.normalCone = cone < 0.5 ? 1.0f : static_cast<float>(4 * cone - 3);  // flat, curved
  g.lower = g.center - 0.5f * g.radius, g.upper = g.center + 0.5f * g.radius;
  return g;
}

/// Of all lamps, by index.
std::vector<double> potentials(const direct::Lamps& lamps, const hierarchy::ElementGeometry& g) {
  std::vector<double> all;
  for (const direct::Lamp& lamp : lamps.all()) all.push_back(potential(lamp, g));
  return all;
}

TEST(LampTree, WhatIsCutOffBringsNoMoreThanItsBound) {
  const Scene scene = lampsOfAllKinds(120);
  const direct::Lamps lamps(scene, scene::scalesOf(scene));
  ASSERT_EQ(lamps.all().size(), 120u);
  Rng random(1);
  LampTree::Cut cut;
  for (int i = 0; i < 400; ++i) {
    const hierarchy::ElementGeometry g = patchOf(random);
    for (const std::size_t most : {0, 3, 24, 1000}) {
      std::vector<double> left = potentials(lamps, g);
      lamps.tree().cut(g, 0, most, 0, cut);
      for (const LampTree::Reaching& r : cut.lamps) {
        EXPECT_DOUBLE_EQ(r.potential, left[r.lamp]);
        left[r.lamp] = 0;
      }
      double sum = 0;
      for (const double x : left) sum += x;
      EXPECT_GE(cut.restMost * (1 + 1e-6), sum) << i << ' ' << most;
      EXPECT_TRUE(most <= lamps.all().size() || sum == 0);
    }
  }
}

TEST(LampTree, ReachesAllThatMayShine) {
  const Scene scene = lampsOfAllKinds(120);
  const direct::Lamps lamps(scene, scene::scalesOf(scene));
  Rng random(2);
  for (int i = 0; i < 400; ++i) {
    const hierarchy::ElementGeometry g = patchOf(random);
    std::vector<double> found(lamps.all().size(), 0);
    lamps.tree().reaching(g, [&](std::uint32_t lamp, double potential) { found[lamp] = potential; });
    EXPECT_EQ(found, potentials(lamps, g));
  }
}

TEST(LampTree, DrawsLampsByTheChanceItSays) {
  const Scene scene = lampsOfAllKinds(60);
  const direct::Lamps lamps(scene, scene::scalesOf(scene));
  constexpr int kDraws = 20000;
  Rng random(3);
  LampTree::Cut cut;
  for (int i = 0; i < 10; ++i) {
    const hierarchy::ElementGeometry g = patchOf(random);
    lamps.tree().cut(g, 1.0 / 16, 24, 0, cut);
    if (!(cut.restMost > 0)) continue;
    std::vector<double> left = potentials(lamps, g), times(lamps.all().size(), 0), chance(lamps.all().size(), 0);
    for (const LampTree::Reaching& r : cut.lamps) left[r.lamp] = 0;
    double exact = 0, estimate = 0;
    for (const double x : left) exact += x;
    for (int k = 0; k < kDraws; ++k) {
      const auto drawn = lamps.tree().draw(cut, g, (k + 0.5) / kDraws);
      if (!drawn) continue;
      EXPECT_GT(left[drawn->lamp], 0);  // none that is asked one by one, nor one in the dark
      times[drawn->lamp] += 1, chance[drawn->lamp] = drawn->chance;
      estimate += left[drawn->lamp] / drawn->chance / kDraws;
    }
    EXPECT_NEAR(estimate, exact, 0.01 * exact);
    for (std::size_t lamp = 0; lamp < times.size(); ++lamp)
      EXPECT_NEAR(times[lamp] / kDraws, chance[lamp], 2.0 / kDraws + 0.01 * chance[lamp]);
  }
}

TEST(LampTree, LooksAtFewOfManyLamps) {
  Scene scene;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j) addLight(scene, PointLight{Vec3(10 * i, 10 * j, 3), Rgb(1.0f)});
  const direct::Lamps lamps(scene, scene::scalesOf(scene));
  hierarchy::ElementGeometry g;
  g.center = Vec3f(201, 201, 0), g.normal = Vec3f(0, 0, 1), g.normalCone = 1, g.radius = 0.1f;
  g.lower = g.center - g.radius, g.upper = g.center + g.radius;
  LampTree::Cut cut;
  lamps.tree().cut(g, 1.0 / 32, 24, 0, cut);
  EXPECT_GE(cut.lamps.size(), 1u);
  EXPECT_LT(cut.rest.size(), 60u);
}

}  // namespace
}  // namespace deltalux
