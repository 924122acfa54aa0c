// deltalux export: a solution to give away.
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/export.hpp>
#include <deltalux/output.hpp>
#include <deltalux/points.hpp>
#include <filesystem>

#include "commands.hpp"
#include "solution_source.hpp"
#include "view_choice.hpp"

namespace deltalux::cli {

namespace {

constexpr double kShareOfError = 0.25;  // standard error of a grid's point, over the error of the solution

struct ExportOptions {
  SolutionSource source;
  RunOptions run;
  std::string output, points, title;
  std::vector<std::string> views;
  std::optional<double> ev;
};

std::string checkEnding(const std::string& output) {
  return std::filesystem::path(output).extension() == ".html" ? "" : fmt::format("'{}' should end in .html", output);
}

/// The table's points by what its column `grid` says, or all as one grid that is named like the file.
std::vector<PageGrid> gridsOf(const Scene& scene, const PointTable& table, const std::string& file) {
  const std::vector<ProbePoint> points = pointsIn(scene, table);
  const auto column = std::ranges::find(table.columns, "grid");
  std::vector<PageGrid> grids;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = column == table.columns.end() ? std::filesystem::path(file).stem().string()
                                                           : table.rows[i][column - table.columns.begin()];
    auto at = std::ranges::find(grids, name, &PageGrid::name);
    if (at == grids.end()) at = grids.insert(grids.end(), {name, {}});
    at->points.push_back(points[i]);
  }
  return grids;
}

void runExport(const ExportOptions& options) {
  Run run("export", options.run);
  checkWritable(options.output);
  PageSettings settings;
  settings.seed = options.run.seed, settings.ev = options.ev;
  std::optional<PointTable> table;
  if (!options.points.empty()) table = readPoints(options.points);
  ProgressPrinter progress(options.run.progressStyle());
  const SolutionView solution = options.source.load(run, options.run, progress, [&](const Scene& scene) {
    for (const std::string& name : options.views) {
      settings.views.push_back(chooseView(scene, name));
      if (settings.views.back().name.empty()) settings.views.back().name = std::filesystem::path(name).stem().string();
    }
  });
  settings.meterError = kShareOfError * solution.settings().error;
  if (table) settings.grids = gridsOf(solution.scene(), *table, options.points);
  settings.title = options.title.empty() ? std::filesystem::path(options.output).stem().string() : options.title;
  exportPage(solution, options.output, settings, &progress);
  run.say(fmt::format("{}: {:.1f} MB", options.output,
                      static_cast<double>(std::filesystem::file_size(options.output)) / 1e6));
  run.finish();
}

}  // namespace

void addExportCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("export", "A page to give away, with dimmers for the lights");
  const auto options = std::make_shared<ExportOptions>();
  options->source.add(*command);
  command->add_option("-o", options->output, "The page: .html")->type_name("OUT.html")->required()->check(checkEnding);
  command
      ->add_option("--view", options->views, "A .vf file, or a view of the scene, to come first; several may be given")
      ->type_name("V");
  command
      ->add_option("--points", options->points,
                   "Points to measure for each group of lights: x,y,z,nx,ny,nz, and by `grid` which belong together")
      ->type_name("P.csv");
  command->add_option("--title", options->title, "What the page is called; otherwise as the file")->type_name("TEXT");
  command->add_option("--ev", options->ev, "Exposure that it opens with, in stops; otherwise as its first view wants")
      ->type_name("N");
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runExport(*options); });
}

}  // namespace deltalux::cli
