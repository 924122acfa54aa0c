#pragma once
// Where a command reads a SOLUTION, a SCENE may stand: it is solved first.
#include <cstdint>
#include <deltalux/edit_io.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution.hpp>
#include <functional>

#include "scene_options.hpp"

namespace deltalux::cli {

/// What SolveSettings say, as options.
struct SolveOptions {
  SolveSettings settings;

  void add(CLI::App&);  // names()
  static std::vector<const char*> names() {
    return {"--error",        "--particles",           "--method",   "--reemitted-share",
            "--diffuse-only", "--no-caustic-textures", "--by-light", "--group"};
  }
  enum class Then : std::uint8_t { Edited, Read };  // what is to become of the solution
  /// Solves; notes times, counts and energy in the run's report. Throws Interrupted.
  SolutionView solve(Scene, Run&, const RunOptions&, Progress&, Then = Then::Edited) const;
};

class SolutionSource {
 public:
  void add(CLI::App&);
  /// Where --by-light, said of this, is about what is read too: a solution must have been solved so. After add().
  void readByLight(CLI::App&, const std::string& description);
  /// A scene is solved by light; a solution is taken as it is.
  void preferByLight() { preferByLight_ = true; }
  /// A solution must have been solved so.
  void wantByLight() { solve_.settings.byLight = true; }
  bool byLight() const { return solve_.settings.byLight; }

  /// Reads the solution, or the scene and solves it; notes times, counts and energy in the run's report. `check` sees
  /// the scene before it is solved, so that a mistake does not wait for that. Throws InputError, Interrupted.
  SolutionView load(Run&, const RunOptions&, Progress&, const std::function<void(const Scene&)>& check = {}) const;

 private:
  SolutionView loadFile(Run&) const;

  SceneOptions scene_;
  SolveOptions solve_;
  bool preferByLight_ = false;
  std::vector<CLI::Option*> sceneOnly_;  // options that a solution leaves nothing to do for
};

/// The options that say how a scene is read and solved: those of SceneOptions and SolveOptions.
std::vector<const char*> sceneAndSolveOptions();
/// What they say, as a recording without any step.
Recording recordingOf(const SceneOptions&, const SolveOptions&, const RunOptions&);

/// Relative standard error that readings of a solution are to have: a quarter of the error that it was solved to.
double meterError(const SolutionView&);
/// Of meters that are read until they have it.
ProbeSettings meterSettings(const SolutionView&, std::uint64_t seed);
/// Illuminance by result [lux].
std::vector<double> luxOf(const std::vector<ProbeResult>&, double luminousEfficacy);

/// Adds what solving did to a run's report.
void noteSolve(const SolveReport&, RunReport&);

}  // namespace deltalux::cli
