// Motion over lines: shadows follow frame by frame, and what it ends at is the fresh solve.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "hierarchy/leaf_table.hpp"
#include "support/furnished_room.hpp"
#include "support/rooms.hpp"
#include "support/run_cli.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A room with a lamp below its ceiling and a board that may come between it and the floor.
Engine roomWithBoard() {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  addBox(scene, white, Vec3(0), {4, 4, 3}, true);
  addBlock(scene, "board", white, {0.1, 0.1, 1.5}, {1.1, 1.1, 1.55});
  addLight(scene, PointLight{{2.5, 2.5, 2.9}, Rgb(1.0f)});
  scene.lights.back().name = "lamp";
  Engine engine(std::move(scene), coarse());
  engine.solve();
  return engine;
}

/// Direct light of the floor about a point, mean [W/m2, gray].
double floorAt(const Engine& engine, const Vec3f& p) {
  const SolutionView view = engine.solution();
  const Solution& s = view.get();
  double light = 0, area = 0;
  for (const hierarchy::ElementId e : hierarchy::LeafTable(s.elements).leaves) {
    const hierarchy::ElementGeometry& g = s.elements.shape(e);
    if (g.normal.z < 0.9f || g.center.z > 0.01f || glm::length(g.center - p) > 0.4f) continue;
    light += g.area * gray(s.elements.radiometry[e.index()].direct), area += g.area;
  }
  return light / area;
}

TEST(LineMotion, ShadowsFollowFrameByFrame) {
  Engine engine = roomWithBoard();
  const Vec3f below(2.5f, 2.5f, 0);
  const double open = floorAt(engine, below);
  engine.select("board");
  for (int i = 0; i < 20; ++i) {
    engine.apply(TransformObject{"board", glm::translate(Mat4(1), Vec3(0.095, 0.095, 0))});
    const StepReport step = engine.frame(20);
    EXPECT_GT(step.deferred, 0u);  // the update is still to come
    EXPECT_TRUE(step.staleW.has_value());
  }
  double stale = 1;
  for (int i = 0; i < 200 && stale > 0; ++i) stale = *engine.frame(20).staleW;
  EXPECT_EQ(stale, 0);
  EXPECT_LT(floorAt(engine, below), 0.05 * open);
  EXPECT_GT(floorAt(engine, {0.7f, 0.7f, 0}), 0.1 * open);  // where the board's shadow was
  engine.update();
  EXPECT_TRUE(isTheFreshOne(engine));
  EXPECT_LT(floorAt(engine, below), 0.01 * open);
}

TEST(LineMotion, DimmedLampsFollow) {
  Engine engine = roomWithBoard();
  const Vec3f below(2.5f, 2.5f, 0);
  const double open = floorAt(engine, below);
  engine.apply(ScaleLight{"lamp", 0.5f});
  for (int i = 0; i < 50; ++i) engine.frame(20);
  EXPECT_NEAR(floorAt(engine, below), 0.5 * open, 0.1 * open);
  engine.update();
  EXPECT_TRUE(isTheFreshOne(engine));
}

TEST(LineMotion, SettlesToWhatOneUpdateGives) {
  const auto box = [] {
    return Engine(loadScene({bundledScene("cornell-caustic/cornell-caustic.rad")}).scene, coarse());
  };
  Engine dragged = box(), atOnce = box();
  dragged.solve(), atOnce.solve();
  ASSERT_GT(dragged.solution().get().caustics.count(), 0u);
  dragged.select("ball");
  const auto shift = [](const char* object, const Vec3& by) {
    return TransformObject{object, glm::translate(Mat4(1), by)};
  };
  const std::vector<Edit> edits{shift("ball", {0.03, 0, 0.02}), shift("ball", {0.03, 0, 0.02}),
                                shift("short_block", {0.02, 0, 0.01}), shift("ball", {-0.02, 0, 0.02}),
                                SetMaterial{"tall_block_surface", Rgb(0.5f), std::nullopt}};
  for (const Edit& e : edits) dragged.apply(e), dragged.frame(1e-3), atOnce.apply(e);
  EXPECT_GE(8 * dragged.solution().report().memory.octree, dragged.solution().get().particles.paths());
  const StepReport settled = dragged.update();
  atOnce.update();
  EXPECT_EQ(settled.deferred, 0u);
  EXPECT_FALSE(settled.staleW);
  EXPECT_EQ(hashOf(dragged), hashOf(atOnce));
  EXPECT_NO_THROW(validate(dragged.solution().get().caustics));
  EXPECT_EQ(dragged.solution().get().caustics.count(), atOnce.solution().get().caustics.count());
}

TEST(LineMotion, EndsAtTheFreshSolveForAnyObject) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  for (const std::string& object : editableOfFurnishedRoom().objects) {
    for (int i = 0; i < 3; ++i) {
      engine.apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0.02, -0.01, 0))});
      engine.frame(5);
    }
    engine.update();
  }
  EXPECT_TRUE(isTheFreshOne(engine));
}

}  // namespace
}  // namespace deltalux
