// deltalux info: what is in a scene, by name and number, and what its import left out; or in a luminaire's file.
#include <fmt/format.h>

#include <algorithm>
#include <deltalux/polar_diagram.hpp>
#include <filesystem>
#include <fstream>

#include "commands.hpp"
#include "scene_options.hpp"
#include "scene_summary.hpp"

namespace deltalux::cli {

namespace {
struct InfoOptions {
  SceneOptions scene;
  RunOptions run;
  std::string diagram;  // file name, empty for none
};

/// Whether the file is XML of Mitsuba's, not of TM-33.
bool holdsScene(const std::string& file) {
  std::string head(4096, '\0');  // a root stands near the beginning
  std::ifstream(file, std::ios::binary).read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find("<scene") != std::string::npos;
}

bool isLuminaire(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension == ".ies" || extension == ".ldt" || extension == ".tm33" ||
         (extension == ".xml" && !holdsScene(file));
}

void describeLuminaire(const Run& run, const std::string& file, const std::string& diagram, bool quiet) {
  std::vector<std::string> warnings;
  const Photometry photometry = loadPhotometry(file, &warnings);
  for (const std::string& warning : warnings) run.say("warning: " + warning);
  const PhotometrySummary s = summarize(photometry);
  const std::string name = std::filesystem::path(file).filename().string();
  if (!diagram.empty()) savePolarDiagram(diagram, photometry, name);
  if (quiet) return;
  fmt::print("{}: {:.0f} lm, {:.0f} % of it downwards\n", name, s.flux, 100 * s.downwards);
  fmt::print("  at most {:.4g} cd, at C {:.4g}, gamma {:.4g} degrees\n", s.peak, s.peakHorizontal, s.peakVertical);
  fmt::print("  half of its plane's most within {:.4g} degrees in C0-C180, {:.4g} in C90-C270\n", s.halfPeak[0],
             s.halfPeak[1]);
  const Vec3& size = photometry.opening;
  if (size.x > 0 || size.y > 0)
    fmt::print("  luminous area {:.4g} m along C0, {:.4g} m along C90, {:.4g} m high\n", size.y, size.x, size.z);
}

void runInfo(const InfoOptions& options) {
  const bool luminaire = options.scene.files.size() == 1 && isLuminaire(options.scene.files.front());
  if (!options.diagram.empty() && !luminaire) throw CLI::ValidationError("-o: only a luminaire has a polar diagram");
  Run run("info", options.run);
  if (luminaire) {
    options.scene.requireEffect();
    run.report.scene = options.scene.files.front();
    describeLuminaire(run, options.scene.files.front(), options.diagram, options.run.quiet);
    return run.finish();
  }
  const ImportedScene imported = options.scene.load(run);
  if (!options.run.quiet) std::fputs(summarize(imported).c_str(), stdout);
  run.finish();
}
}  // namespace

void addInfoCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "info", "What is in a scene, and what its import ignored; or in a luminaire's file (.ies, .ldt, .xml of TM-33)");
  const auto options = std::make_shared<InfoOptions>();
  options->scene.add(*command);
  command->add_option("-o", options->diagram, "Where the polar diagram of a luminaire goes")->type_name("OUT.svg");
  options->run.addReport(*command);
  command->callback([options] { runInfo(*options); });
}

}  // namespace deltalux::cli
