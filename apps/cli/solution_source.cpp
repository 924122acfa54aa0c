#include "solution_source.hpp"

namespace deltalux::cli {

void SolutionSource::add(CLI::App& app) {
  scene_.add(app);
  app.add_option("--error", settings_.error, "Target relative error of irradiance, solving the scene")
      ->type_name("E")
      ->check(CLI::Range(1e-4, 0.999))
      ->capture_default_str();
  app.add_flag("--diffuse-only", settings_.diffuseOnly,
               "Drop specular lobes and mirrors; thin glass still passes light");
}

Engine SolutionSource::solve(Run& run, const RunOptions& options, Progress& progress,
                             const std::function<void(const Scene&)>& check) const {
  ImportedScene imported = scene_.load(run);
  if (check) check(imported.scene);
  SolveSettings settings = settings_;
  settings.seed = options.seed;
  Engine engine(std::move(imported.scene), settings);
  noteSolve(engine.solve(&progress), run.report);
  return engine;
}

void noteSolve(const SolveReport& solved, RunReport& report) {
  const double import = report.times.import;
  report.times = solved.times;
  report.times.import = import;
  report.counts = solved.counts;
  report.memory = solved.memory;
  report.energy = solved.energy;
}

}  // namespace deltalux::cli
