// Updates over links: what a fresh solve of the edited scene gives.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "hierarchy/side_locator.hpp"
#include "support/furnished_room.hpp"
#include "support/residue.hpp"
#include "support/run_cli.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

constexpr double kError = 0.02;

Engine solvedBox() {
  return test::solved(loadScene({test::bundledScene("cornell/cornell.rad")}).scene, kError, SolveMethod::Paper);
}

Edit moveBlock(const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{"short_block", matrix};
}

/// How far irradiance at the leaves of one solution is from what another has there, relative to that and to a tenth of
/// its mean at least.
test::Spread difference(const Engine& a, const Engine& b) {
  const Solution &s = a.solution().get(), &t = b.solution().get();
  const hierarchy::SideLocator locator(t.elements, t.scene);
  const auto irradiance = [](const hierarchy::ElementLight& l) { return gray(l.direct + l.indirect + l.particle); };
  const float floor = 0.1f * irradiance(t.elements.radiometry[t.elements.sceneRoot.index()]);
  std::vector<double> differences;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (!s.elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const hierarchy::PatchDomain& d = s.elements.domain[i];
    const hierarchy::ElementId side = locator.side(d.primitive, d.triangle, s.elements.topology[i].front);
    if (!side.valid()) continue;
    const hierarchy::ElementId leaf = locator.locate(side, Vec3(s.elements.geometry[i].center)).leaf;
    const float E = irradiance(t.elements.radiometry[leaf.index()]);
    differences.push_back(std::abs(irradiance(s.elements.radiometry[i]) - E) / std::max(E, floor));
  }
  return test::spreadOf(std::move(differences));
}

void expectAsFresh(const Engine& engine) {
  test::expectValid(engine, "update");
  const Engine fresh = test::solved(engine.solution().scene(), kError, SolveMethod::Paper);
  const test::Spread between = difference(engine, fresh);
  EXPECT_LT(between.median, kError);
  EXPECT_LT(between.p95, 0.2);
  EXPECT_NEAR(test::residue(engine.balance()), test::residue(fresh.solution().report().energy), 0.005);
}

TEST(PaperUpdate, MovingABlockIsSolvingTheMovedScene) {
  Engine engine = solvedBox();
  engine.apply(moveBlock({0.03, 0, -0.02}));
  const StepReport step = engine.update();
  EXPECT_GT(step.linksVisited, 0u);
  EXPECT_GT(step.linksChanged, 0u);
  EXPECT_LT(step.rays, engine.solution().report().counts.raysVisibility);
  expectAsFresh(engine);
}

TEST(PaperUpdate, DimmingALampIsSolvingTheDimmedScene) {
  Engine engine = solvedBox();
  engine.apply(ScaleLight{"lamp", 0.3f});
  engine.update();
  expectAsFresh(engine);
  engine.apply(ScaleLight{"lamp", 2.0f});
  engine.apply(moveBlock({-0.02, 0.05, 0}));
  engine.update();
  expectAsFresh(engine);
}

TEST(PaperUpdate, ComesBackToWhereItWas) {
  Engine engine = solvedBox();
  const Engine first = solvedBox();
  for (int i = 0; i < 4; ++i) engine.apply(moveBlock({0.01, 0, 0})), engine.update();
  engine.apply(moveBlock({-0.04, 0, 0}));
  engine.update();
  const test::Spread between = difference(engine, first);
  EXPECT_LT(between.median, 0.5 * kError);
  EXPECT_LT(between.p95, 0.1);
}

TEST(PaperUpdate, FramesAndTheUpdateComeToWhatOneUpdateDoes) {
  Engine dragged = solvedBox(), moved = solvedBox();
  for (const Vec3& by : {Vec3(0.02, 0, 0), Vec3(0.01, 0, -0.02)}) {
    dragged.apply(moveBlock(by));
    EXPECT_GT(dragged.frame(10).linksChanged, 0u);
  }
  dragged.update();
  moved.apply(moveBlock({0.03, 0, -0.02}));
  moved.update();
  const test::Spread between = difference(dragged, moved);
  EXPECT_LT(between.median, 1e-3);
  EXPECT_LT(between.p95, 0.05);
}

TEST(PaperUpdate, WhatIsHiddenForAWhileStaysRefined) {
  Engine engine = test::solved(test::furnishedRoom(), 0.1, SolveMethod::Paper);
  int kept = 0;
  for (int i = 0; i < 4; ++i) {
    const std::vector<hierarchy::Link> before = engine.solution().get().links.all;
    Mat4 matrix(1.0);
    matrix[3] = glm::dvec4(-0.3, 0.1, 0, 1);
    engine.apply(TransformObject{"box", matrix});
    engine.update();
    const hierarchy::Links& links = engine.solution().get().links;
    for (std::size_t id = 0; id < before.size(); ++id) {
      const hierarchy::Link &was = before[id], &is = links.all[id];
      const bool same =
          was.state == hierarchy::LinkState::Interior && was.receiver == is.receiver && was.sender == is.sender;
      if (!same || was.unseen() || !is.unseen()) continue;
      EXPECT_EQ(is.state, hierarchy::LinkState::Interior) << id;
      ++kept;
    }
  }
  EXPECT_GT(kept, 0);
}

TEST(PaperUpdate, FollowsAFurnishedRoom) {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 20000, settings.method = SolveMethod::Paper;
  Engine engine(test::furnishedRoom(), settings);
  engine.solve();
  test::RandomEdits edits(engine, test::editableOfFurnishedRoom(), 5);
  for (int i = 0; i < 8; ++i) {
    edits.step();
    test::expectValid(engine, edits.last());
  }
  test::expectAsSolved(engine, settings, 0.03, 0.3);
}

}  // namespace
}  // namespace deltalux
