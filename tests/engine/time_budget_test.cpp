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
  const Engine engine = solved(loadScene({bundledScene("cornell/cornell.rad")}).scene, 0.2);
  const Solution& s = engine.solution().get();
  radiosity::OracleSettings oracle;
  oracle.error = 4;
  const radiosity::LinkErrors errors(s.links, s.elements, oracle);
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

TEST(TimeBudget, WhatStandsWhenTimeIsUpHoldsTogether) {
  SolveSettings settings;
  settings.error = 0.002, settings.seconds = 0.3;
  Engine engine(loadScene({bundledScene("cornell/cornell.rad")}).scene, settings);
  const SolveReport report = engine.solve();
  EXPECT_FALSE(report.converged);
  EXPECT_LT(report.times.total, 5);  // a busy machine may be slow; without a limit it takes minutes
  const Solution& s = engine.solution().get();
  EXPECT_NO_THROW(validate(s.elements));
  EXPECT_NO_THROW(validate(s.links, s.elements));
  EXPECT_FALSE(s.transfers.empty());
  EXPECT_NO_THROW(s.transfers.validate(s.elements, s.links));
  EXPECT_LT(*report.energy.unsettledW, 1e-2 * *report.energy.emittedW);
}

TEST(TimeBudget, RaysShrinkToTheTimeLeft) {
  const radiosity::LeafTransferSettings all;
  EXPECT_EQ(shrunk(all, 1, 2).gatherRays, all.gatherRays);
  EXPECT_EQ(shrunk(all, 2, 1).gatherRays, all.gatherRays / 2);
  EXPECT_GT(shrunk(all, 1e9, 1).gatherRays, 0);
}

}  // namespace
}  // namespace deltalux
