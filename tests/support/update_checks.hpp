#pragma once
// What must hold of an engine after any edits.
#include <gtest/gtest.h>

#include <deltalux/check.hpp>

#include "support/solved.hpp"

namespace deltalux::test {

inline void expectValid(const Engine& engine, const std::string& after) {
  const Solution& s = engine.solution().get();
  ASSERT_NO_THROW(validate(s.scene)) << after;
  ASSERT_NO_THROW(validate(s.elements)) << after;
  ASSERT_NO_THROW(validate(s.links, s.elements)) << after;
  ASSERT_NO_THROW(validate(s.particles, s.scene)) << after;
  ASSERT_NO_THROW(validate(s.caustics)) << after;
}

/// For small scenes, where bounds are wide.
inline constexpr CheckSettings kQuickCheck{2000, 0.01};

inline void expectAsSolved(const Engine& engine, const SolveSettings& settings, double median, double p95,
                           const CheckSettings& measured = kQuickCheck) {
  Engine fresh(engine.solution().scene(), settings);
  fresh.solve();
  const CheckReport check = compareSolutions(engine.solution(), fresh.solution(), measured);
  EXPECT_LT(check.medianRelDiff, median);
  EXPECT_LT(check.p95RelDiff, p95);
  EXPECT_TRUE(check.particlesIdentical);
}

}  // namespace deltalux::test
