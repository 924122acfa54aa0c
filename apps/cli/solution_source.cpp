#include <fmt/format.h>

#include "solution_source.hpp"

#include <deltalux/engine.hpp>
#include <deltalux/solution_file.hpp>

#include "dark_scene.hpp"
#include "interrupt.hpp"

namespace deltalux::cli {

void SolveOptions::add(CLI::App& app) {
  app.add_option("--error", settings.error, "Target relative error of irradiance, solving the scene")
      ->type_name("E")
      ->check(CLI::Range(1e-4, 0.999))
      ->capture_default_str();
  app.add_option("--particles", settings.particles,
                 "About how many particles carry light over mirrors, gloss and glass; without it as --error wants")
      ->type_name("N")
      ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 28));
  app.add_option_function<std::string>(
         "--method",
         [this](const std::string& name) {
           settings.method = name == "paper" ? SolveMethod::Paper : SolveMethod::Lines;
         },
         "How diffuse light is exchanged: over stored lines, or over links of clusters")
      ->check(CLI::IsMember({"lines", "paper"}))
      ->type_name("lines|paper");
  app.add_flag("--diffuse-only", settings.diffuseOnly,
               "Drop specular lobes and mirrors; thin glass still passes light");
  app.add_flag("!--no-caustic-textures", settings.causticTextures,
               "Show the light of particles on a finer mesh instead of in caustic textures");
}

SolutionView SolveOptions::solve(Scene scene, Run& run, const RunOptions& options, Progress& progress,
                                 Then then) const {
  SolveSettings withSeed = settings;
  withSeed.seed = options.seed;
  Engine engine(std::move(scene), withSeed);
  const SolveReport report = engine.solve(&progress);
  noteSolve(report, run.report);
  run.report.caustics = engine.solution().caustics();
  if (report.cutParticles > 0)
    run.say(
        fmt::format("warning: {} of {} particles were cut after 64 reflections and refractions; their light is lost",
                    report.cutParticles, report.counts.particles));
  if (then == Then::Read) engine.forget();
  return engine.solution();
}

void SolutionSource::add(CLI::App& app) {
  scene_.add(app);
  solve_.add(app);
  app.get_option("SCENE")->description(
      "A solution (.dlx); or a scene, which is solved first: .gltf, .glb, .obj, or .rad files in order");
  for (const char* name : sceneAndSolveOptions()) sceneOnly_.push_back(app.get_option(name));
}

SolutionView SolutionSource::load(Run& run, const RunOptions& options, Progress& progress,
                                  const std::function<void(const Scene&)>& check) const {
  if (scene_.files.size() == 1 && isSolutionFile(scene_.files.front())) {
    const SolutionView solution = loadFile(run);
    if (check) check(solution.scene());
    return solution;
  }
  ImportedScene imported = scene_.load(run);
  if (check) check(imported.scene);
  return solve_.solve(std::move(imported.scene), run, options, progress);
}

SolutionView SolutionSource::loadFile(Run& run) const {
  for (const CLI::Option* option : sceneOnly_)
    if (option->count() > 0)
      throw CLI::ValidationError(option->get_name() + ": a solution is solved already; name the scene instead");
  const double begin = run.elapsed();
  run.report.scene = scene_.files.front();
  SolutionView solution = loadSolution(scene_.files.front());
  warnIfDark(solution.scene(), run);
  run.report.sceneStats = sceneStats(solution.scene());
  noteSolve(solution.report(), run.report);
  run.report.caustics = solution.caustics();
  run.report.times = {};  // of this run
  run.report.times.import = run.elapsed() - begin;
  throwIfInterrupted();
  return solution;
}

std::vector<const char*> sceneAndSolveOptions() {
  std::vector<const char*> names = SceneOptions::names();
  for (const char* name : SolveOptions::names()) names.push_back(name);
  return names;
}

Recording recordingOf(const SceneOptions& scene, const SolveOptions& solve, const RunOptions& run) {
  Recording recording;
  recording.scene = {scene.files.begin(), scene.files.end()};
  recording.luminaires = scene.hung();
  recording.import = scene.import;
  recording.settings = solve.settings;
  recording.settings.seed = run.seed;
  return recording;
}

void noteSolve(const SolveReport& solved, RunReport& report) {
  const double import = report.times.import;
  report.times = solved.times;
  report.times.import = import;
  report.counts = solved.counts;
  report.memory = solved.memory;
  report.error = solved.error;
  report.energy = solved.energy;
}

}  // namespace deltalux::cli
