#include <fmt/format.h>

#include "solution_source.hpp"

#include <deltalux/engine.hpp>
#include <deltalux/error.hpp>
#include <deltalux/light_groups.hpp>
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
  app.add_option("--reemitted-share", settings.reemittedShare,
                 "By --method paper, of the links of particles that a motion affects, the share emitted again a frame")
      ->type_name("S")
      ->check(CLI::Range(1e-6, 1.0))
      ->capture_default_str();
  app.add_flag("--diffuse-only", settings.diffuseOnly,
               "Drop specular lobes and mirrors; thin glass still passes light");
  app.add_flag("!--no-caustic-textures", settings.causticTextures,
               "Show the light of particles on a finer mesh instead of in caustic textures");
  app.add_flag("--by-light", settings.byLight,
               "Keep the light of each lamp, of each sun and of the skies apart: dimming is a weight then");
  app.add_option_function<std::vector<std::string>>(
         "--group",
         [this](const std::vector<std::string>& groups) {
           for (const std::string& group : groups) {
             const std::size_t at = group.find('=');
             if (at == 0 || at == std::string::npos || at + 1 == group.size())
               throw CLI::ValidationError("--group " + group + ": not NAME=PATTERN");
             settings.groups.push_back({group.substr(0, at), group.substr(at + 1)});
           }
           settings.byLight = true;
         },
         "Lights that are dimmed together, by their names, in which * stands for anything; implies --by-light; may be "
         "repeated")
      ->type_name("NAME=PATTERN")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

SolutionView SolveOptions::solve(Scene scene, Run& run, const RunOptions& options, Progress& progress,
                                 Then then) const {
  for (const LightPattern& p : settings.groups)
    if (lightsMatching(scene, p.pattern).empty()) {
      std::vector<std::string> names;
      for (const Light& light : scene.lights) names.push_back(light.name);
      throw CLI::ValidationError(fmt::format("--group {}={}: no light is called so; there {} {}", p.group, p.pattern,
                                             names.size() == 1 ? "is" : "are",
                                             fmt::join(nearMisses(p.pattern, names), ", ")));
    }
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
      "A solution (.dlx); or a scene, which is solved first: .gltf, .glb, .obj, .xml (Mitsuba), .pbrt, or .rad files "
      "in order");
  for (const char* name : sceneAndSolveOptions()) sceneOnly_.push_back(app.get_option(name));
}

void SolutionSource::readByLight(CLI::App& app, const std::string& description) {
  CLI::Option* option = app.get_option("--by-light");
  option->description(description);
  std::erase(sceneOnly_, option);
}

SolutionView SolutionSource::load(Run& run, const RunOptions& options, Progress& progress,
                                  const std::function<void(const Scene&)>& check) const {
  if (scene_.files.size() == 1 && isSolutionFile(scene_.files.front())) {
    const SolutionView solution = loadFile(run);
    if (byLight() && !solution.settings().byLight)
      throw InputError(scene_.files.front(), 0, "does not keep its lights apart", "solve the scene with --by-light");
    if (check) check(solution.scene());
    return solution;
  }
  ImportedScene imported = scene_.load(run);
  if (check) check(imported.scene);
  SolveOptions solving = solve_;
  if (preferByLight_ && solving.settings.method == SolveMethod::Lines) solving.settings.byLight = true;
  return solving.solve(std::move(imported.scene), run, options, progress);
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
  recording.daylight = scene.daylight();
  recording.settings = solve.settings;
  recording.settings.seed = run.seed;
  return recording;
}

double meterError(const SolutionView& solution) { return 0.25 * solution.settings().error; }

ProbeSettings meterSettings(const SolutionView& solution, std::uint64_t seed) {
  ProbeSettings settings;
  settings.error = meterError(solution), settings.seed = seed;
  settings.maxSamples = 1 << 17;  // lines or shadow rays of a point
  return settings;
}

std::vector<double> luxOf(const std::vector<ProbeResult>& results, double luminousEfficacy) {
  std::vector<double> lux;
  for (const ProbeResult& r : results) lux.push_back(photometric(r.irradiance, luminousEfficacy));
  return lux;
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
