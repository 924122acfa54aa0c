// deltalux update: a solution, brought up to edits of its scene; deltalux replay: the same edit by edit, measured.
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/check.hpp>
#include <deltalux/edit_io.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/output.hpp>
#include <deltalux/solution_file.hpp>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

const char* sameness(bool identical) { return identical ? "identical" : "differ"; }

/// Edits in order, undo and redo among them.
class Session {
 public:
  explicit Session(Engine& engine) : engine_(engine) {}

  StepReport take(const EditStep& step, Progress& progress) {
    std::visit([&](const auto& s) { apply(s); }, step);
    return engine_.update(&progress);
  }
  StepReport show(const EditStep& step, double milliseconds) {
    std::visit([&](const auto& s) { apply(s); }, step);
    return engine_.frame(milliseconds);
  }

 private:
  void apply(const Edit& edit) {
    undo_.push_back(engine_.apply(edit));
    redo_.clear();
  }
  void apply(const Undo&) { move(undo_, redo_); }
  void apply(const Redo&) { move(redo_, undo_); }
  void move(std::vector<Restore>& from, std::vector<Restore>& to) {
    const Restore back = from.back();
    from.pop_back();
    to.push_back(engine_.apply(back));
  }

  Engine& engine_;
  std::vector<Restore> undo_, redo_;
};

struct UpdateOptions {
  SolutionSource source;
  SceneOptions scene;
  SolveOptions solve;
  RunOptions run;
  std::string edits, output, record;
  bool check = false;
  double frameMs = 0;  // 0: no motion
};

bool isRecording(const std::string& file) { return std::filesystem::path(file).extension() == ".json"; }

/// What replay is to play: a recording, or what its options say.
Recording sessionOf(const UpdateOptions& options, const CLI::App& command) {
  if (options.scene.files.size() == 1 && isRecording(options.scene.files.front())) {
    std::vector<const char*> others = sceneAndSolveOptions();
    for (const char* name : {"--seed", "--edits"}) others.push_back(name);
    for (const char* name : others)
      if (command.get_option(name)->count() > 0)
        throw CLI::ValidationError(std::string(name) + ": a recording says that itself");
    return loadRecording(options.scene.files.front());
  }
  if (options.edits.empty()) throw CLI::RequiredError("--edits (or a recording in place of SCENE)");
  Recording session = recordingOf(options.scene, options.solve, options.run);
  session.steps = loadEdits(options.edits, session.import);
  return session;
}

/// A bug report is a file: it is there before anything is solved.
void record(const UpdateOptions& options, const Recording& session) {
  const auto folderOf = [](const std::string& file) { return std::filesystem::absolute(file).parent_path(); };
  const bool adds = std::any_of(session.steps.begin(), session.steps.end(), [](const EditStep& step) {
    const auto* edit = std::get_if<Edit>(&step);
    return edit && std::holds_alternative<AddObject>(*edit);
  });
  const std::string& from = options.edits.empty() ? options.scene.files.front() : options.edits;
  if (adds && folderOf(options.record) != folderOf(from))
    throw CLI::ValidationError("--record " + options.record +
                               ": edits that add files are recorded in the folder of those files");
  saveRecording(options.record, session);
}

void describe(const StepReport& step, Run& run) {
  std::string line =
      fmt::format("{} {}: {:.0f} ms, {} leaves changed, {} of {} particles retraced, {} rays", step.op, step.object,
                  1e3 * step.times.total, step.leavesChanged, step.particlesRetraced, step.particlesTotal, step.rays);
  if (step.staleW) line += fmt::format(", {} deferred, {:.3g} W stale", step.deferred, *step.staleW);
  run.say(line);
}

void runUpdate(const UpdateOptions& options) {
  if (!isSolutionFile(options.output))
    throw CLI::ValidationError(fmt::format("-o {}: a solution's name ends in .dlx", options.output));
  Run run("update", options.run);
  checkWritable(options.output);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const std::vector<EditStep> steps = loadEdits(options.edits);
    Engine engine(options.source.load(run, options.run, progress, [&](const Scene& scene) {
      Scene lit = scene;
      addAreaLights(lit);
      validateEdits(std::move(lit), steps, options.edits);
    }));
    Session session(engine);
    for (const EditStep& step : steps) run.report.steps.push_back(session.take(step, progress));
    run.report.memory.octree = engine.solution().report().memory.octree;
    saveSolution(options.output, engine.solution());
  }
  for (const StepReport& step : run.report.steps) describe(step, run);
  run.finish();
}

/// Every edit a frame, and an update when motion stops.
void drag(Engine& engine, Session& session, const std::vector<EditStep>& steps, double frameMs,
          std::vector<StepReport>& rows, Progress& progress) {
  for (const EditStep& step : steps)
    if (const auto* edit = std::get_if<Edit>(&step))
      if (const auto* moves = std::get_if<TransformObject>(edit)) engine.select(moves->object);
  for (const EditStep& step : steps) rows.push_back(session.show(step, frameMs));
  rows.push_back(engine.update(&progress));
  rows.back().op = "settle";
}

void runReplay(const UpdateOptions& options, const CLI::App& command) {
  const Recording session = sessionOf(options, command);
  RunOptions running = options.run;
  running.seed = session.settings.seed;
  Run run("replay", running);
  if (!options.record.empty()) checkWritable(options.record);
  {
    ProgressPrinter progress(running.progressStyle());
    if (!options.edits.empty()) options.scene.requireEffect();
    ImportedScene imported = importScene(run, session.scene, session.luminaires, session.import, session.daylight);
    addAreaLights(imported.scene);
    validateEdits(imported.scene, session.steps, options.edits.empty() ? options.scene.files.front() : options.edits);
    if (!options.record.empty()) record(options, session);
    SolveOptions solving = options.solve;
    solving.settings = session.settings;
    Engine engine(solving.solve(std::move(imported.scene), run, running, progress));
    Session playing(engine);
    if (options.frameMs > 0)
      drag(engine, playing, session.steps, options.frameMs, run.report.steps, progress);
    else
      for (const EditStep& step : session.steps) run.report.steps.push_back(playing.take(step, progress));
    run.report.memory.octree = engine.solution().report().memory.octree;
    if (options.check) {
      Engine fresh(engine.solution().scene(), engine.solution().settings());
      const SolveReport solved = fresh.solve(&progress);
      run.report.check = compareSolutions(engine.solution(), fresh.solution(), {}, &progress);
      run.report.check->solveS = solved.times.total;
    }
  }
  for (const StepReport& step : run.report.steps) describe(step, run);
  if (const auto& check = run.report.check)
    run.say(
        fmt::format("against a solve from scratch ({:.1f} s): median {:.3f} %, 95 % within {:.3f} %; mesh {}, lines "
                    "{}, particles {}",
                    check->solveS, 100 * check->medianRelDiff, 100 * check->p95RelDiff, sameness(check->meshIdentical),
                    sameness(check->linesIdentical), sameness(check->particlesIdentical)));
  run.finish();
}

}  // namespace

void addUpdateCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("update", "Bring a solution up to edits of its scene");
  const auto options = std::make_shared<UpdateOptions>();
  options->source.add(*command);
  command->add_option("--edits", options->edits, "What to do to the scene")->type_name("E.json")->required();
  command->add_option("-o", options->output, "Where the updated solution goes")->type_name("SOLUTION.dlx")->required();
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runUpdate(*options); });
}

void addReplayCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("replay", "Solve a scene, then apply edits one by one and say what each cost");
  const auto options = std::make_shared<UpdateOptions>();
  options->scene.add(*command);
  command->get_option("SCENE")->description(
      ".gltf, .glb, .obj, .xml (Mitsuba) or .pbrt, or .rad files in order; or a recording (.json)");
  options->solve.add(*command);
  command->add_option("--edits", options->edits, "What to do to the scene")->type_name("E.json");
  command->add_option("--record", options->record, "Write scene, settings and edits as a recording that replays")
      ->type_name("FILE.json");
  command
      ->add_option("--frame-ms", options->frameMs,
                   "As a drag: each edit takes about that long and leaves the rest for later; then all is settled")
      ->check(CLI::PositiveNumber);
  command->add_flag("--check", options->check, "At the end solve from scratch too, and say what differs");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options, command] { runReplay(*options, *command); });
}

}  // namespace deltalux::cli
