#pragma once
// Where a command reads a SOLUTION, a SCENE may stand: it is solved first.
#include <deltalux/engine.hpp>
#include <functional>

#include "scene_options.hpp"

namespace deltalux::cli {

class SolutionSource {
 public:
  void add(CLI::App&);

  /// Reads the scene and solves it; notes times, counts and energy in the run's report. `check` sees the scene before
  /// it is solved, so that a mistake does not wait for that. Throws InputError, Interrupted.
  Engine solve(Run&, const RunOptions&, Progress&, const std::function<void(const Scene&)>& check = {}) const;

 private:
  SceneOptions scene_;
  SolveSettings settings_;
};

/// Adds what solving did to a run's report.
void noteSolve(const SolveReport&, RunReport&);

}  // namespace deltalux::cli
