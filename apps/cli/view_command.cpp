// deltalux view: the interactive viewer, by hand or by script.
#include <fmt/format.h>

#include <deltalux/edit_io.hpp>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>
#include <deltalux/solution_file.hpp>

#include "commands.hpp"
#include "script_driver.hpp"
#include "solution_source.hpp"
#include "viewer.hpp"

namespace deltalux::cli {

namespace {

struct ViewOptions {
  SceneOptions scene;
  SolveOptions solve;
  RunOptions run;
  std::string view, script, record;
  std::optional<double> ev;
  viewer::Solver::Settings solver;
};

bool isSession(const std::string& file) { return std::filesystem::path(file).extension() == ".json"; }

/// What is to be opened, and how. Throws InputError, CLI::ValidationError.
Recording toOpen(const ViewOptions& options, const CLI::App& command) {
  const std::string& first = options.scene.files.front();
  const bool alone = options.scene.files.size() == 1;
  if (alone && (isSession(first) || isSolutionFile(first))) {
    std::vector<const char*> others = sceneAndSolveOptions();
    for (const char* name : {"--seed", "--seconds"}) others.push_back(name);
    for (const char* name : others)
      if (command.get_option(name)->count() > 0)
        throw CLI::ValidationError(std::string(name) +
                                   (isSession(first) ? ": a session says that itself"
                                                     : ": a solution is solved already; name the scene instead"));
    if (isSession(first)) return loadRecording(first);
  } else {
    options.scene.requireEffect();
  }
  return recordingOf(options.scene, options.solve, options.run);
}

/// The scene as the recording's steps leave it, not yet solved; or the solution.
std::unique_ptr<Engine> open(const Recording& recording, Run& run) {
  if (recording.scene.size() == 1 && isSolutionFile(recording.scene.front())) {
    SolutionView solution = loadSolution(recording.scene.front());
    return std::make_unique<Engine>(std::move(solution));
  }
  ImportedScene imported =
      importScene(run, recording.scene, recording.luminaires, recording.import, recording.daylight);
  addAreaLights(imported.scene);
  EditHistory history;
  for (const EditStep& step : recording.steps) applyStep(imported.scene, history, step);
  return std::make_unique<Engine>(std::move(imported.scene), recording.settings);
}

/// A view file needs no scene to be wrong.
std::optional<View> viewOf(const ViewOptions& options) {
  if (options.view.empty()) return std::nullopt;
  return loadView(options.view);
}

void runView(const ViewOptions& options, const CLI::App& command) {
  const auto start = viewer::ScriptDriver::Clock::now();
  std::optional<viewer::Script> script;
  if (!options.script.empty()) script = viewer::loadScript(options.script);
  const Recording recording = toOpen(options, command);
  if (!options.record.empty()) checkWritable(options.record);
  Run run("view", options.run);

  viewer::ViewerOptions viewing;
  viewing.source.open = [&](Progress&) { return open(recording, run); };
  viewing.source.recording = [&] { return recording; };
  viewing.source.record = options.record;
  viewing.source.view = viewOf(options);
  viewing.solver = options.solver;
  viewing.title = options.scene.files.front();
  viewing.ev = options.ev;
  std::optional<viewer::ScriptDriver> driver;
  if (script) {
    viewing.width = script->width, viewing.height = script->height;
    viewing.panels = script->panels;
    driver.emplace(std::move(*script), start, [](const std::string& line) {
      fmt::print("{}\n", line);
      std::fflush(stdout);
    });
    viewing.driver = &*driver;
  }
  try {
    viewer::runViewer(viewing);
  } catch (const viewer::NoDisplay& missing) {
    throw OutputError(missing.what());
  }
  run.finish();
}

}  // namespace

void addViewCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("view", "Look at a scene, move things and lamps, and see the light follow");
  const auto options = std::make_shared<ViewOptions>();
  options->scene.add(*command);
  command->get_option("SCENE")->description(
      "A scene (.gltf, .glb, .obj, .xml (Mitsuba) or .pbrt, or .rad files in order), a solution (.dlx), or a session "
      "(.json)");
  options->solve.add(*command);
  command->add_option("--seconds", options->solve.settings.seconds, "Solve for about that long at most")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command->add_option("--view", options->view, "A .vf file to begin with; otherwise the scene's first view")
      ->type_name("V.vf");
  command->add_option("--ev", options->ev, "Exposure in stops; otherwise found once, from the first picture")
      ->type_name("N");
  command->add_option("--frame-ms", options->solver.frameMs, "What a frame may take while things move")
      ->type_name("N")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--motion-share", options->solver.motionShare,
                   "Share of it that light may take; the rest of the light follows when the hand rests")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command->add_option("--record", options->record, "Write the session after every action, as replay reads it")
      ->type_name("FILE.json");
  command->add_option("--script", options->script, "Do what a file says, without hands or panels, and close")
      ->type_name("FILE");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options, command] { runView(*options, *command); });
}

}  // namespace deltalux::cli
