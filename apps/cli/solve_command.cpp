// deltalux solve: the solution of a scene, into a file.
#include <fmt/format.h>

#include <deltalux/output.hpp>
#include <deltalux/solution_file.hpp>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {
struct SolveCommandOptions {
  SceneOptions scene;
  SolveOptions solve;
  RunOptions run;
  std::string output;
};

void runSolve(const SolveCommandOptions& options) {
  if (!isSolutionFile(options.output))
    throw CLI::ValidationError(fmt::format("-o {}: a solution's name ends in .dlx", options.output));
  Run run("solve", options.run);
  checkWritable(options.output);
  {
    ProgressPrinter progress(options.run.progressStyle());
    ImportedScene imported = options.scene.load(run);
    const SolutionView solution =
        options.solve.solve(std::move(imported.scene), run, options.run, progress, SolveOptions::Then::Read);
    saveSolution(options.output, solution);
    if (!solution.report().converged) run.say("warning: the time was up before the target error was met everywhere");
  }
  const WorkCounts& counts = run.report.counts;
  const auto exchange =
      counts.links > 0 ? fmt::format("{} links", counts.links) : fmt::format("{} lines", counts.lines);
  run.say(fmt::format("{}: {} elements, {}, {:.1f} s", options.output, counts.elements, exchange, run.elapsed()));
  run.finish();
}
}  // namespace

void addSolveCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("solve", "Solve a scene and keep the solution in a file");
  const auto options = std::make_shared<SolveCommandOptions>();
  options->scene.add(*command);
  options->solve.add(*command);
  command->add_option("--seconds", options->solve.settings.seconds, "End after about this long, with what fits")
      ->type_name("S")
      ->check(CLI::PositiveNumber);
  command->add_option("-o", options->output, "Where the solution goes")->type_name("SOLUTION.dlx")->required();
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runSolve(*options); });
}

}  // namespace deltalux::cli
