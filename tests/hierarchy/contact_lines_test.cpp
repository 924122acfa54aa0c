// Patches are split along the feet of walls that cross them.
#include "hierarchy/contact_lines.hpp"

#include <gtest/gtest.h>

#include <deltalux/edit.hpp>
#include <deltalux/solution_file.hpp>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "hierarchy/build.hpp"
#include "hierarchy/patch.hpp"
#include "support/solved.hpp"

namespace deltalux {
using namespace hierarchy;

namespace {

/// A square of ground, 8 by 8, with something on it.
struct Ground {
  Scene scene;
  MaterialId grey;
  Elements elements;

  explicit Ground(const std::function<void(Ground&)>& build) {
    grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
    test::addPolygon(scene, grey, {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}});
    build(*this);
    elements = buildElements(scene, surfaceSides(scene));
  }
  void box(const Vec3& lower, const Vec3& upper) { test::addBox(scene, grey, lower, upper, false); }
  ElementId side(bool front = true) const { return elements.side(PrimitiveId(0u), 0, front); }
  Walls walls(ElementId patch) const { return wallsAcross(elements, scene, patch); }
};

TEST(ContactLines, APatchIsSplitAlongAWallsTwoFaces) {
  Ground ground([](Ground& g) { g.box({4.2, 0, 0}, {4.6, 8, 3}); });
  ASSERT_TRUE(subdivide(ground.elements, ground.scene, ground.side()));
  ASSERT_EQ(ground.elements.at(ground.side()).childCount, 2);
  const ElementId near = ground.elements.child(ground.side(), 0), far = ground.elements.child(ground.side(), 1);
  EXPECT_FLOAT_EQ(ground.elements.shape(near).upper.x, 4.2f);
  EXPECT_NEAR(ground.elements.shape(near).area, 4.2 * 8, 1e-3);
  EXPECT_FALSE(ground.walls(near));
  ASSERT_TRUE(subdivide(ground.elements, ground.scene, far));
  EXPECT_FLOAT_EQ(ground.elements.shape(ground.elements.child(far, 0)).upper.x, 4.6f);
  EXPECT_FALSE(ground.walls(ground.elements.child(far, 1)));
  validate(ground.elements);
}

TEST(ContactLines, AHousesCornerSplitsBothWays) {
  Ground ground([](Ground& g) { g.box({2, 3, 0}, {9, 9, 3}); });
  ASSERT_TRUE(subdivide(ground.elements, ground.scene, ground.side()));
  ASSERT_EQ(ground.elements.at(ground.side()).childCount, 4);
  EXPECT_FLOAT_EQ(ground.elements.shape(ground.elements.child(ground.side(), 0)).upper.x, 2.0f);
  EXPECT_FLOAT_EQ(ground.elements.shape(ground.elements.child(ground.side(), 0)).upper.y, 3.0f);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_FALSE(ground.walls(ground.elements.child(ground.side(), i)));
}

TEST(ContactLines, AWallInPartsIsOne) {
  const Ground ground([](Ground& g) {
    g.box({3, 0, 0}, {3.4, 2.5, 3});
    g.box({3, 4, 0}, {3.4, 6, 3});
  });
  ASSERT_TRUE(ground.walls(ground.side()));
  EXPECT_FLOAT_EQ(*ground.walls(ground.side()).u, 3.4f / 8);
  EXPECT_FALSE(ground.walls(ground.side()).v);
}

TEST(ContactLines, AWallThatGoesThroughStandsOnBothSides) {
  const Ground ground([](Ground& g) { g.box({3, 0, -2}, {3.4, 8, 3}); });
  EXPECT_TRUE(ground.walls(ground.side(true)));
  EXPECT_TRUE(ground.walls(ground.side(false)));
  const Ground below([](Ground& g) { g.box({3, 0, -2}, {3.4, 8, 0}); });
  EXPECT_FALSE(below.walls(below.side(true)));
  EXPECT_TRUE(below.walls(below.side(false)));
}

TEST(ContactLines, WhatPartsNothingIsNone) {
  const auto stands = [](const std::function<void(Ground&)>& build) {
    const Ground ground(build);
    return static_cast<bool>(ground.walls(ground.side()));
  };
  EXPECT_TRUE(stands([](Ground& g) { g.box({3, 0, 0}, {3.4, 8, 3}); }));
  EXPECT_FALSE(stands([](Ground& g) { g.box({3, 0, 0}, {3.4, 8, 0.5}); })) << "a step";
  EXPECT_FALSE(stands([](Ground& g) { g.box({3, 3, 0}, {3.4, 3.4, 3}); })) << "a post";
  EXPECT_FALSE(stands([](Ground& g) { g.box({3, 0, 0.5}, {3.4, 8, 3}); })) << "a screen off the ground";
  EXPECT_FALSE(stands([](Ground& g) { g.box({0.01, 0, 0}, {0.02, 8, 3}); })) << "along the edge";
  EXPECT_FALSE(stands([](Ground& g) {
    test::addPolygon(g.scene, g.grey, {{1, 0, 0}, {5, 8, 0}, {5, 8, 3}, {1, 0, 3}});
  })) << "askew: patches are rectangles";
  EXPECT_FALSE(stands([](Ground& g) {
    test::addPolygon(g.scene, g.grey, {{3, 0, 0}, {3, 8, 0}, {7, 8, 2}, {7, 0, 2}});
  })) << "a ramp";
  EXPECT_FALSE(stands([](Ground& g) {
    const MaterialId pane = test::addMaterial(g.scene, "pane", Dielectric{});
    test::addBox(g.scene, pane, {3, 0, 0}, {3.4, 8, 3}, false);
  })) << "glass";
}

TEST(ContactLines, AStepPartsSmallPatches) {
  Ground ground([](Ground& g) { g.box({3.5, 0, 0}, {3.8, 8, 0.5}); });
  ASSERT_TRUE(subdivide(ground.elements, ground.scene, ground.side()));  // 4 by 4
  const ElementId quarter = ground.elements.child(ground.side(), 0);
  EXPECT_FALSE(ground.walls(quarter));
  ASSERT_TRUE(subdivide(ground.elements, ground.scene, quarter));  // 2 by 2
  EXPECT_TRUE(ground.walls(ground.elements.child(quarter, 1)));
}

/// A lit room with a screen in it.
Scene screened() {
  Scene scene;
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  test::addBox(scene, grey, {0, 0, 0}, {8, 8, 4}, true);
  const std::size_t first = scene.primitives.size();
  test::addBox(scene, grey, {3, 0.5, 0}, {3.4, 7.5, 3}, false);
  const ObjectId screen = internObject(scene, "screen", '.');
  for (std::size_t i = first; i < scene.primitives.size(); ++i) scene.primitives[i].object = screen;
  test::addLight(scene, PointLight{{1, 4, 3.5}, Rgb(10.0f)});
  return scene;
}

/// All walls that cross any element of a solution.
std::vector<float> wallsOf(const Solution& s) {
  std::vector<float> all;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (!s.elements.isPatch(ElementId(i))) continue;
    const Walls w = wallsAcross(s.elements, s.scene, ElementId(i));
    all.push_back(w.u.value_or(-1)), all.push_back(w.v.value_or(-1));
  }
  return all;
}

TEST(ContactLines, NoLeafLiesOnBothSidesOfAWall) {
  Engine engine = test::solved(screened(), 0.1);
  const Solution& s = engine.solution().get();
  std::size_t split = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (!s.elements.isPatch(ElementId(i)) || s.elements.at(ElementId(i)).emitter) continue;
    const bool crossed = static_cast<bool>(wallsAcross(s.elements, s.scene, ElementId(i)));
    if (s.elements.isReceivingLeaf(ElementId(i)))
      EXPECT_FALSE(crossed) << i;
    else
      split += crossed;
  }
  EXPECT_GT(split, 0u);
}

TEST(ContactLines, AreThoseOfTheSceneAtRestAlsoInAFile) {
  Engine engine = test::solved(screened(), 0.1);
  engine.apply(TransformObject{"screen", glm::translate(Mat4(1.0), Vec3(2, 0, 0))});
  engine.update();
  const Solution& moved = engine.solution().get();
  const auto path = std::filesystem::path(testing::TempDir()) / "contact_lines.dlx";
  saveSolution(path, engine.solution());
  const SolutionView loaded = loadSolution(path);
  std::filesystem::remove(path);
  EXPECT_EQ(wallsOf(loaded.get()), wallsOf(moved));

  const Elements afresh = buildElements(moved.scene, surfaceSides(moved.scene)),
                 before = buildElements(screened(), surfaceSides(screened()));
  const auto floorOf = [](const Elements& e) { return wallsAcross(e, screened(), e.side(PrimitiveId(0u), 0, true)); };
  EXPECT_EQ(floorOf(afresh).u, floorOf(before).u);
  EXPECT_EQ(floorOf(afresh).v, floorOf(before).v);
}

}  // namespace
}  // namespace deltalux
