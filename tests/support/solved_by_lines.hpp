#pragma once
// Solutions of small scenes over lines.
#include "base/random.hpp"
#include "solution/solution.hpp"
#include "support/solved.hpp"

namespace deltalux::test {

/// For tests of what holds at any error: soon done.
inline SolveSettings coarseLines() {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 20000, settings.method = SolveMethod::Lines;
  return settings;
}

inline Engine solvedByLines(Scene scene, double error = 0.05) {
  return solved(std::move(scene), error, SolveMethod::Lines);
}

/// Of its mesh, and where all lines and particles go.
inline std::uint64_t hashOf(const Engine& engine) {
  const SolutionHashes hashes = hashesOf(engine.solution().get());
  return combineKeys(combineKeys(hashes.mesh, hashes.lines), hashes.particles);
}

}  // namespace deltalux::test
