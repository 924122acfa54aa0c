// What is told to turn away has nothing in front of it, on patches of all shapes.
#include "paper/facing.hpp"

#include <gtest/gtest.h>

#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "support/solved.hpp"

namespace deltalux {
using namespace paper;

namespace {

Scene roomOfRoundThings() {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.6f));
  test::addBox(scene, grey, {0, 0, 0}, {4, 3, 2.5}, true);
  test::addShape(scene, grey, Sphere{{3, 0.8, 0.5}, 0.4});
  test::addShape(scene, grey, Cylinder{{1, 1, 0}, {1.2, 1.3, 1.5}, 0.1});
  test::addShape(scene, grey, Cylinder{{2, 2, 0.1}, {2, 2, 1.1}, 0.3, true});  // seen from within
  test::addShape(scene, grey, Cone{{0.6, 2.3, 0}, {0.6, 2.3, 0.8}, 0.4, 0.1});
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
  test::addPolygon(scene, lamp, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  return scene;
}

TEST(Facing, WhatTurnsAwayHasNothingBeforeIt) {
  const Engine engine = test::solved(roomOfRoundThings(), 0.1);
  const Solution& s = engine.solution().get();
  std::vector<hierarchy::ElementId> curved, patches;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (!s.elements.isPatch(hierarchy::ElementId(i)) || s.elements.topology[i].emitter) continue;
    patches.emplace_back(i);
    if (!s.elements.topology[i].flat && s.elements.topology[i].childCount == 0) curved.emplace_back(i);
  }
  ASSERT_GT(curved.size(), 20u);
  Rng rng(3);
  const auto any = [&](const std::vector<hierarchy::ElementId>& of) {
    return of[static_cast<std::size_t>(rng.uniform() * static_cast<double>(of.size()))];
  };
  int away = 0, told = 0;
  for (int pair = 0; pair < 20000; ++pair) {
    const hierarchy::ElementId a = any(curved), b = any(patches);
    const bool turned = turnsAway(s.elements.shape(a), s.elements.shape(b));
    float most = -1;
    for (int i = 0; i < 16; ++i) {
      const hierarchy::PatchPoint y = hierarchy::samplePatch(s.elements, s.scene, a, rng.uniform(), rng.uniform());
      const hierarchy::PatchPoint x = hierarchy::samplePatch(s.elements, s.scene, b, rng.uniform(), rng.uniform());
      const Vec3f d = x.position - y.position;
      if (glm::length(d) > 0) most = std::max(most, glm::dot(y.normal, d) / glm::length(d));
    }
    if (turned) {
      EXPECT_LT(most, 1e-4f) << a.value << " from " << b.value;
    }
    away += most <= 0, told += turned;
  }
  EXPECT_GT(away, 2000);
  EXPECT_GT(told, away / 3);
}

TEST(Facing, OfAFlatPatchIsWhatLiesBehindItsPlane) {
  hierarchy::ElementGeometry patch, box;
  patch.lower = {0, 0, 0}, patch.upper = {1, 1, 0}, patch.normal = {0, 0, 1}, patch.normalCone = 1;
  box.lower = {2, 2, -1}, box.upper = {3, 3, 0};
  EXPECT_TRUE(turnsAway(patch, box));
  box.upper.z = 0.001f;
  EXPECT_FALSE(turnsAway(patch, box));
}

}  // namespace
}  // namespace deltalux
