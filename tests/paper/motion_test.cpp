// A drag over links: frames re-emit a share of the particle links that it affects, and the update the rest.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "support/residue.hpp"
#include "support/run_cli.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

SolveSettings settings(double share = 0.1) {
  SolveSettings s;
  s.error = 0.1, s.particles = 8000, s.method = SolveMethod::Paper, s.reemittedShare = share;
  return s;
}

Engine solvedBox(double share = 0.1) {
  Engine engine(loadScene({test::bundledScene("cornell-caustic/cornell-caustic.rad")}).scene, settings(share));
  engine.solve();
  return engine;
}

/// Measuring through a caustic takes many rays.
constexpr CheckSettings kFewPoints{300, 0.01};

Edit moveBall(const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{"ball", matrix};
}

TEST(PaperMotion, AtRestADragIsTheFullUpdate) {
  Engine dragged = solvedBox(), moved = solvedBox();
  dragged.select("ball");
  EXPECT_GT(dragged.solution().report().memory.octree, 0u);
  for (int frame = 0; frame < 5; ++frame) {
    dragged.apply(moveBall({0.02, 0, 0.01}));
    const StepReport step = dragged.frame(10);
    EXPECT_GT(step.deferred, 0u);
    EXPECT_GT(step.particlesRetraced, 0u);
    test::expectValid(dragged, "frame");
  }
  EXPECT_EQ(dragged.update().deferred, 0u);
  EXPECT_EQ(dragged.frame(10).deferred, 0u);
  moved.apply(moveBall({0.1, 0, 0.05}));
  moved.update();
  EXPECT_EQ(dragged.solution().get().particles.hash(), moved.solution().get().particles.hash());
  const CheckReport between = compareSolutions(dragged.solution(), moved.solution(), kFewPoints);
  EXPECT_LT(between.medianRelDiff, 1e-3);
  EXPECT_LT(between.p95RelDiff, 0.02);
  test::expectAsSolved(dragged, settings(), 0.03, 0.3, kFewPoints);
}

TEST(PaperMotion, FramesWithoutEditsGoOn) {
  Engine engine = solvedBox(0.5);
  engine.apply(moveBall({0.05, 0, 0.05}));
  std::uint64_t waiting = engine.frame(10).deferred;
  ASSERT_GT(waiting, 0u);
  for (int i = 0; i < 16 && waiting > 0; ++i) {
    const std::uint64_t now = engine.frame(10).deferred;
    EXPECT_EQ(now, waiting / 2);  // the share is the user's
    waiting = now;
  }
  EXPECT_EQ(waiting, 0u);
  test::expectAsSolved(engine, settings(), 0.03, 0.3, kFewPoints);
}

/// What a link that waits has sent stays where it was: never nowhere, never twice.
TEST(PaperMotion, NoFrameLosesOrDoublesEnergy) {
  Engine engine = solvedBox();
  const double atRest = test::residue(engine.balance());
  for (int frame = 0; frame < 3; ++frame) {
    engine.apply(moveBall({0.02, 0, 0.02}));
    engine.frame(10);
    EXPECT_NEAR(test::residue(engine.balance()), atRest, 0.01);
  }
}

TEST(PaperMotion, LightsWaitForTheUpdate) {
  Engine engine = solvedBox();
  engine.apply(ScaleLight{"lamp", 0.5f});
  EXPECT_EQ(engine.frame(10).deferred, 1u);
  engine.apply(moveBall({0.02, 0, 0.02}));
  EXPECT_GT(engine.frame(10).deferred, 1u);
  engine.update();
  test::expectAsSolved(engine, settings(), 0.03, 0.3, kFewPoints);
}

}  // namespace
}  // namespace deltalux
