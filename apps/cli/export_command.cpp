// deltalux export: a solution to give away, as a page (.html) or as geometry with its light (.glb).
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/export.hpp>
#include <deltalux/export_glb.hpp>
#include <deltalux/output.hpp>
#include <deltalux/points.hpp>
#include <filesystem>

#include "commands.hpp"
#include "solution_source.hpp"
#include "view_choice.hpp"

namespace deltalux::cli {

namespace {

struct ExportOptions {
  SolutionSource source;
  RunOptions run;
  std::string output;
  std::optional<double> ev;
  // Of a page.
  std::string points, title;
  std::vector<std::string> views;
  // Of geometry.
  GlbSettings glb;
  std::string lightmap = "moz";
  bool unlit = false;
  std::vector<const char*> pageOnly, glbOnly;  // options

  bool isPage() const { return std::filesystem::path(output).extension() == ".html"; }
};

std::string checkEnding(const std::string& output) {
  const std::string ending = std::filesystem::path(output).extension().string();
  return ending == ".html" || ending == ".glb" ? "" : fmt::format("'{}' should end in .html or .glb", output);
}

/// Options are of what is written.
void checkOptions(const ExportOptions& options, const CLI::App& command) {
  for (const char* name : options.isPage() ? options.glbOnly : options.pageOnly)
    if (command.get_option(name)->count() > 0)
      throw CLI::ValidationError(fmt::format("{}: {} has no such thing", name, options.isPage() ? ".html" : ".glb"));
  if (options.isPage()) return;
  if (options.ev && !options.unlit) throw CLI::ValidationError("--ev: of a .glb, it is the exposure of --unlit");
  if (options.unlit && command.get_option("--lightmap")->count() > 0)
    throw CLI::ValidationError("--lightmap: --unlit has none");
  if (options.unlit && options.source.byLight())
    throw CLI::ValidationError("--unlit: what is tone-mapped is no sum; leave out --by-light");
}

/// The table's points by what its column `grid` says, or all as one grid that is named like the file.
std::vector<PageGrid> gridsOf(const Scene& scene, const PointTable& table, const std::string& file) {
  const std::vector<ProbePoint> points = pointsIn(scene, table);
  const std::optional<std::size_t> column = table.column("grid");
  std::vector<PageGrid> grids;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string name = column ? table.rows[i][*column] : std::filesystem::path(file).stem().string();
    auto at = std::ranges::find(grids, name, &PageGrid::name);
    if (at == grids.end()) at = grids.insert(grids.end(), {name, {}});
    at->points.push_back(points[i]);
  }
  return grids;
}

void exportPage(const ExportOptions& options, Run& run) {
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
  settings.meterError = meterError(solution);
  if (table) settings.grids = gridsOf(solution.scene(), *table, options.points);
  settings.title = options.title.empty() ? std::filesystem::path(options.output).stem().string() : options.title;
  deltalux::exportPage(solution, options.output, settings, &progress);
  run.say(fmt::format("{}: {:.1f} MB", options.output,
                      static_cast<double>(std::filesystem::file_size(options.output)) / 1e6));
}

GlbReport writeGlb(const ExportOptions& options, const SolutionView& solution, Progress& progress) {
  if (options.unlit) return exportUnlitGlb(solution, options.output, options.ev, options.glb, &progress);
  if (options.source.byLight()) return exportGlbByLight(solution, options.output, options.glb, &progress);
  return exportGlb(solution, options.output, options.glb, &progress);
}

void sayGlb(const ExportOptions& options, const GlbReport& report, const Run& run) {
  run.say(fmt::format("{}: {} triangles, {} charts on {} pages of light, {:.3g} texels per metre, {:.1f} MB",
                      report.files[0].string(), report.triangles, report.charts, report.pages, report.texelsPerMetre,
                      1e-6 * static_cast<double>(report.bytes)));
  for (std::size_t i = 1; i < report.files.size(); ++i) run.say(report.files[i].string());
  if (options.unlit && !options.ev) run.say(fmt::format("exposure chosen: --ev {:.1f}", report.ev));
}

void exportGeometry(const ExportOptions& options, Run& run) {
  std::optional<GlbReport> report;
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution = options.source.load(run, options.run, progress);
    report = writeGlb(options, solution, progress);
  }
  sayGlb(options, *report, run);
}

void runExport(ExportOptions& options, const CLI::App& command) {
  checkOptions(options, command);
  options.glb.lightmap = options.lightmap == "mx" ? LightmapExtension::Mx : LightmapExtension::Moz;
  Run run("export", options.run);
  checkWritable(options.output);
  if (options.isPage()) {
    options.source.preferByLight();
    exportPage(options, run);
  } else {
    exportGeometry(options, run);
  }
  run.finish();
}

/// Returns their names.
std::vector<const char*> addGlbOptions(CLI::App& command, ExportOptions& options) {
  command.add_option("--texels-per-metre", options.glb.texelsPerMetre, "Of lightmaps (default: what one page holds)")
      ->type_name("N")
      ->check(CLI::Range(1e-6, 1e6));
  command.add_option("--atlas-size", options.glb.atlasSize, "Side of a page of lightmaps at most, in texels")
      ->type_name("N")
      ->check(CLI::Range(64, 16384))
      ->capture_default_str();
  command.add_flag("--unlit", options.unlit, "Shown as it is by any viewer: tone-mapped colours");
  options.source.readByLight(command, "An .exr more for each group of lights; of a .glb");
  command.add_flag("--meshopt", options.glb.meshopt, "Geometry packed without loss (EXT_meshopt_compression)");
  command
      .add_option("--lightmap", options.lightmap,
                  "MOZ_lightmap (8 linear bits, by material) or MX_lightmap (RGBM, by node: dark parts are as exact)")
      ->type_name("moz|mx")
      ->check(CLI::IsMember({"moz", "mx"}))
      ->capture_default_str();
  return {"--texels-per-metre", "--atlas-size", "--unlit", "--by-light", "--meshopt", "--lightmap"};
}

/// Returns their names.
std::vector<const char*> addPageOptions(CLI::App& command, ExportOptions& options) {
  command
      .add_option("--view", options.views, "A .vf file, or a view of the scene, to come first; several may be given")
      ->type_name("V");
  command
      .add_option("--points", options.points,
                  "Points to measure for each group of lights: x,y,z,nx,ny,nz, and by `grid` which belong together")
      ->type_name("P.csv");
  command.add_option("--title", options.title, "What the page is called; otherwise as the file")->type_name("TEXT");
  return {"--view", "--points", "--title"};
}

}  // namespace

void addExportCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("export", "A page with dimmers for the lights, or geometry with its light for other programs");
  const auto options = std::make_shared<ExportOptions>();
  options->source.add(*command);
  command->add_option("-o", options->output, "A page, or geometry: irradiance goes beside it, as OUT.lightmap.exr")
      ->type_name("OUT.html|OUT.glb")
      ->required()
      ->check(checkEnding);
  command->add_option("--ev", options->ev, "Exposure in stops: that a page opens with, or of --unlit (default: chosen)")
      ->type_name("N")
      ->check(CLI::Range(-100.0, 100.0));
  options->pageOnly = addPageOptions(*command, *options);
  options->glbOnly = addGlbOptions(*command, *options);
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options, command] { runExport(*options, *command); });
}

}  // namespace deltalux::cli
