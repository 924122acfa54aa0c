// Limited time: what is aimed at, and what stands when the time is up.
#include "engine/time_budget.hpp"

#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "support/run_cli.hpp"
#include "support/solved.hpp"

namespace deltalux {
using namespace engine;

namespace {

using namespace test;

TEST(TimeBudget, MoreTimeReachesASmallerError) {
  const Engine engine = solved(loadScene({bundledScene("cornell/cornell.rad")}).scene, 0.2, SolveMethod::Paper);
  const Solution& s = engine.solution().get();
  paper::OracleSettings oracle;
  oracle.error = 4;
  const paper::LinkErrors errors(s.links, s.elements, oracle);
  EXPECT_GT(errors.madeBy(0.5), errors.madeBy(1.0));
  EXPECT_GT(errors.madeBy(1.0), 0);

  TimeBudget budget(1);
  budget.learn(1.0, 1000, 1000);  // a millisecond a link
  double before = 4;
  for (const double seconds : {0.0, 1.0, 10.0, 1000.0}) {
    const double error = budget.reach(errors, 4, 0.01, seconds);
    EXPECT_LE(error, before) << seconds;
    if (error < 4) {
      EXPECT_LE(budget.cost(errors.madeBy(error)), seconds);
    }
    before = error;
  }
  EXPECT_LT(before, 4);
  EXPECT_EQ(budget.reach(errors, 4, 0.01, 1e9), 0.01);
}

/// A pane in a wide field: of a hundred thousand particles that start, few find it, so that each one is dear.
Scene paneInAField() {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.5f));
  const MaterialId glass = addMaterial(scene, "glass", ThinGlass{Rgb(0.7f), 1.52f});
  addPolygon(scene, grey, {{-500, -500, 0}, {500, -500, 0}, {500, 500, 0}, {-500, 500, 0}});
  addBox(scene, grey, {0, 0, 0.1}, {3, 3, 2}, false);
  addBox(scene, grey, {0.1, 0.1, 0.2}, {2.9, 2.9, 1.9}, true);
  addPolygon(scene, glass, {{0.5, 0.05, 0.5}, {2.5, 0.05, 0.5}, {2.5, 0.05, 1.5}, {0.5, 0.05, 1.5}});
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(1.0f), UniformSky{1}, {0, 0, 1}});
  addLight(scene, SunLight{glm::normalize(Vec3(0.2, -1, 1)), 0.004654793, Rgb(1e5f)});
  return scene;
}

TEST(TimeBudget, ParticlesAreAsManyAsThereIsTimeFor) {
  SolveSettings settings;
  settings.particles = 3000000, settings.seconds = 1, settings.method = SolveMethod::Paper;
  Engine engine(paneInAField(), settings);
  const SolveReport report = engine.solve();
  EXPECT_FALSE(report.converged);
  EXPECT_LT(report.times.total, 6);  // a busy machine may be slow; without a limit it takes minutes
  const Solution& s = engine.solution().get();
  EXPECT_LT(s.settings.particles, 3000000u) << "updates trace as many as there are";
  EXPECT_GE(s.settings.particles, 1024u);
  EXPECT_EQ(s.particles.hash(),
            particles::traceParticles(s.scene, *s.tracer, {s.settings.particles, s.settings.seed}).hash());
  EXPECT_NO_THROW(validate(s.elements));
  EXPECT_NO_THROW(validate(s.links, s.elements));
  EXPECT_LT(*report.energy.unsettledW, 1e-2 * *report.energy.emittedW);
}

}  // namespace
}  // namespace deltalux
