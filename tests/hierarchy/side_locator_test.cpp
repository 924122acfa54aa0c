// Which element holds a point of a surface, also when others were removed.
#include "hierarchy/side_locator.hpp"

#include <gtest/gtest.h>

#include "support/solved.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

TEST(SideLocator, WhatWasRemovedHasNoSideAndTakesNoOthers) {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.5f));
  test::addBox(scene, white, {0, 0, 0}, {2, 2, 2}, true);
  const auto nameLast = [&](std::size_t first, const char* object) {
    const ObjectId id = internObject(scene, object, '.');
    for (std::size_t i = first; i < scene.primitives.size(); ++i) scene.primitives[i].object = id;
  };
  test::addBox(scene, white, {0.5, 0.5, 0.5}, {0.8, 0.8, 0.8}, false);
  nameLast(6, "one");
  test::addBox(scene, white, {1.2, 1.2, 0.5}, {1.5, 1.5, 0.8}, false);
  nameLast(12, "other");
  PointLight bulb;
  bulb.position = {1, 1, 1.5}, bulb.intensity = Rgb(1.0f);
  test::addLight(scene, bulb);
  Engine engine = test::solved(std::move(scene), 0.1);
  for (const char* gone : {"one", "other"}) {  // one before others, and the last of all
    engine.apply(RemoveObject{gone});
    engine.update();
    const Solution& s = engine.solution().get();
    const SideLocator locator(s.elements, s.scene);
    for (std::size_t i = 0; i < s.scene.primitives.size(); ++i) {
      for (const bool front : {true, false}) {
        const ElementId side = locator.side(PrimitiveId(i), 0, front);
        if (!side.valid()) continue;
        EXPECT_GT(area(s.scene.primitives[i].shape), 0);
        EXPECT_EQ(s.elements.domain[side.index()].primitive, PrimitiveId(i));
        EXPECT_EQ(s.elements.at(side).front, front);
      }
    }
    EXPECT_TRUE(locator.side(PrimitiveId(0), 0, true).valid());
  }
}

}  // namespace
}  // namespace deltalux
