// deltalux sheet: what a lighting design was asked for and what it has, as a document to sign.
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/output.hpp>
#include <deltalux/sheet.hpp>
#include <filesystem>

#include "commands.hpp"
#include "solution_source.hpp"

namespace deltalux::cli {

namespace {

struct SheetOptions {
  SolutionSource source;
  RunOptions run;
  SheetSettings sheet;
  std::string areas, output;
};

std::string checkSheetName(const std::string& file) {
  if (file.ends_with(".html")) return "";
  if (!file.ends_with(".pdf")) return "a sheet is a .pdf or a .html";
  return canWritePdf() ? "" : "this deltalux was built without Cairo, which writes PDF: name an .html instead";
}

std::string shown(const SheetRow& row, double value) {
  return row.unit.empty() ? fmt::format("{:.3g}", value) : fmt::format("{:.4g} {}", value, row.unit);
}

void describe(const Sheet& sheet) {
  std::size_t failed = 0;
  for (const MeasuredArea& area : sheet.areas) {
    fmt::print("{}: {}\n", area.area.name, area.passes() ? "pass" : "FAIL");
    failed += area.passes() ? 0 : 1;
    for (const SheetRow& row : area.rows)
      if (row.required)
        fmt::print("  {}: {}, required {} {}: {}{}\n", row.quantity, shown(row, row.reached),
                   row.atMost ? "at most" : "at least", shown(row, *row.required), row.passes() ? "pass" : "FAIL",
                   row.close() ? " (nearer than the error)" : "");
      else
        fmt::print("  {}: {}\n", row.quantity, shown(row, row.reached));
  }
  fmt::print("{} of {} areas pass\n", sheet.areas.size() - failed, sheet.areas.size());
}

void runSheet(const SheetOptions& options) {
  Run run("sheet", options.run);
  checkWritable(options.output);
  const SheetRequest request = loadSheetRequest(options.areas);
  {
    ProgressPrinter progress(options.run.progressStyle());
    const SolutionView solution = options.source.load(
        run, options.run, progress, [&](const Scene& scene) { validateSheetRequest(request, scene); });
    SheetSettings settings = options.sheet;
    settings.probe = meterSettings(solution, options.run.seed);
    const std::string scene = std::filesystem::path(run.report.scene).filename().string();
    const Sheet sheet = measureSheet(solution, request, scene, settings, &progress);
    saveSheet(options.output, sheet);
    if (!options.run.quiet) describe(sheet);
  }
  run.finish();
}

}  // namespace

void addSheetCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("sheet", "What areas are to have and what they have, as a document to sign");
  const auto options = std::make_shared<SheetOptions>();
  options->source.add(*command);
  command->add_option("--areas", options->areas, "The areas and what they are to have (docs/sheet.md)")
      ->type_name("A.json")
      ->required();
  command->add_option("-o", options->output, "Where the sheet goes")
      ->type_name("S.pdf|S.html")
      ->check(checkSheetName)
      ->required();
  command->add_option("--width", options->sheet.width, "Of the rendering, at most [pixels]")
      ->check(CLI::Range(64, 8192))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--samples", options->sheet.samplesPerPixel, "Rays of a pixel of the rendering")
      ->check(CLI::Range(1, 1 << 16))
      ->type_name("N")
      ->capture_default_str();
  options->run.addLongWork(*command);
  options->run.addReport(*command);
  command->callback([options] { runSheet(*options); });
}

}  // namespace deltalux::cli
