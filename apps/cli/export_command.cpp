// deltalux export: a solution for other programs.
#include <fmt/format.h>

#include <deltalux/export_glb.hpp>
#include <deltalux/output.hpp>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

struct ExportOptions {
  SolutionSource source;
  RunOptions run;
  std::string output;
  GlbSettings glb;
  bool unlit = false, byLight = false;
  std::optional<double> ev;
};

void checkOutputs(const ExportOptions& options) {
  const std::string ending = std::filesystem::path(options.output).extension().string();
  if (ending != ".glb") throw CLI::ValidationError(fmt::format("-o {}: what is exported ends in .glb", options.output));
  checkWritable(options.output);
}

GlbReport writeGlb(const ExportOptions& options, const SolutionView& solution, Progress& progress) {
  if (options.unlit) return exportUnlitGlb(solution, options.output, options.ev, options.glb, &progress);
  if (options.byLight) return exportGlbByLight(solution, options.output, options.glb, &progress);
  return exportGlb(solution, options.output, options.glb, &progress);
}

void sayGlb(const ExportOptions& options, const GlbReport& report, const Run& run) {
  run.say(fmt::format("{}: {} triangles, {} charts on {} pages of light, {:.3g} texels per metre, {:.1f} MB",
                      report.files[0].string(), report.triangles, report.charts, report.pages, report.texelsPerMetre,
                      1e-6 * static_cast<double>(report.bytes)));
  for (std::size_t i = 1; i < report.files.size(); ++i) run.say(report.files[i].string());
  if (options.unlit && !options.ev) run.say(fmt::format("exposure chosen: --ev {:.1f}", report.ev));
}

void runExport(const ExportOptions& options) {
  checkOutputs(options);
  Run run("export", options.run);
  std::optional<GlbReport> report;
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution = options.source.load(run, options.run, progress);
    report = writeGlb(options, solution, progress);
  }
  sayGlb(options, *report, run);
  run.finish();
}

void addGlbOptions(CLI::App& command, ExportOptions& options) {
  command.add_option("--texels-per-metre", options.glb.texelsPerMetre, "Of lightmaps (default: what one page holds)")
      ->type_name("N")
      ->check(CLI::Range(1e-6, 1e6));
  command.add_option("--atlas-size", options.glb.atlasSize, "Side of a page of lightmaps at most, in texels")
      ->type_name("N")
      ->check(CLI::Range(64, 16384))
      ->capture_default_str();
  CLI::Option* unlit = command.add_flag("--unlit", options.unlit, "Shown as it is by any viewer: tone-mapped colours");
  command.add_option("--ev", options.ev, "Exposure of --unlit in stops (default: chosen)")
      ->type_name("N")
      ->check(CLI::Range(-100.0, 100.0))
      ->needs(unlit);
  command.add_flag("--by-light", options.byLight, "An .exr more for each group of lights that was solved apart")
      ->excludes(unlit);
  command.add_flag("--meshopt", options.glb.meshopt, "Geometry packed without loss (EXT_meshopt_compression)");
}

}  // namespace

void addExportCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("export", "Geometry with its light, for other programs");
  const auto options = std::make_shared<ExportOptions>();
  options->source.add(*command);
  command->add_option("-o", options->output, "OUT.glb; irradiance goes beside it, as OUT.lightmap.exr")
      ->type_name("OUT.glb")
      ->required();
  addGlbOptions(*command, *options);
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runExport(*options); });
}

}  // namespace deltalux::cli
