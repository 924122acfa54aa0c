// deltalux probe: irradiance at points, from the solution.
#include <fmt/format.h>

#include <deltalux/light_groups.hpp>
#include <deltalux/output.hpp>
#include <deltalux/points.hpp>
#include <deltalux/render.hpp>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {
struct ProbeOptions {
  SolutionSource source;
  RunOptions run;
  std::string points, output;
  bool mesh = false;
};

/// Each group's lux at the points, all groups by themselves: a column each.
void probeByLight(const ProbeOptions& options, const SolutionView& solution, const PointTable& table,
                  const ProbeSettings& settings, Progress& progress) {
  const std::vector<ProbePoint> points = pointsIn(solution.scene(), table);
  std::vector<std::string> names;
  for (const LightGroup& group : lightGroups(solution)) names.push_back(group.name);
  const std::vector<std::vector<ProbeResult>> results = probeByLight(solution, points, settings, &progress);
  writeProbeColumns(options.output, table, names, results, solution.scene().luminousEfficacy);
}

void runProbe(const ProbeOptions& options) {
  Run run("probe", options.run);
  checkWritable(options.output);
  const PointTable table = readPoints(options.points);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution = options.source.load(run, options.run, progress);
    ProbeSettings settings = meterSettings(solution, options.run.seed);
    settings.mesh = options.mesh;
    if (options.source.byLight()) {
      probeByLight(options, solution, table, settings, progress);
    } else {
      const std::vector<ProbeResult> results = probe(solution, pointsIn(solution.scene(), table), settings, &progress);
      writeProbeResults(options.output, table, results, solution.scene().luminousEfficacy);
    }
  }
  run.say(fmt::format("{}: {} points", options.output, table.points.size()));
  run.finish();
}
}  // namespace

void addProbeCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("probe", "Irradiance at points, from a solution");
  const auto options = std::make_shared<ProbeOptions>();
  options->source.add(*command);
  command->add_option("--points", options->points, "Points to measure: columns x,y,z,nx,ny,nz")
      ->type_name("P.csv")
      ->required();
  command->add_option("-o", options->output, "Where the rows with E_r, E_g, E_b, lux and se_r, se_g, se_b go")
      ->type_name("OUT.csv")
      ->required();
  command->add_flag("--mesh", options->mesh, "The mesh's own values: nothing reconstructed, no shadow rays");
  options->source.readByLight(
      *command, "A column lux_NAME for each group of lights instead: what it brings at scale 1, all others off");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runProbe(*options); });
}

}  // namespace deltalux::cli
