#pragma once
// Solutions of small scenes over lines.
#include "base/random.hpp"
#include "hierarchy/leaf_table.hpp"
#include "lines/lines.hpp"
#include "support/solved.hpp"

namespace deltalux::test {

inline Engine solvedByLines(Scene scene, double error = 0.05) {
  return solved(std::move(scene), error, SolveMethod::Lines);
}

/// Of where all lines and particles go.
inline std::uint64_t hashOf(const Engine& engine) {
  const SolutionView view = engine.solution();
  const Solution& s = view.get();
  const hierarchy::LeafTable leaves(s.elements);
  std::vector<std::uint64_t> keys;
  for (const hierarchy::ElementId leaf : leaves.leaves) keys.push_back(s.elements.key[leaf.index()]);
  return combineKeys(s.lines.hash(keys), s.particles.hash());
}

}  // namespace deltalux::test
