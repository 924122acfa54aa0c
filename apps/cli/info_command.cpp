// deltalux info: what is in a scene, by name and number, and what its import left out.
#include "commands.hpp"
#include "scene_options.hpp"
#include "scene_summary.hpp"

namespace deltalux::cli {

namespace {
struct InfoOptions {
  SceneOptions scene;
  RunOptions run;
};

void runInfo(const InfoOptions& options) {
  Run run("info", options.run);
  const ImportedScene imported = options.scene.load(run);
  if (!options.run.quiet) std::fputs(summarize(imported).c_str(), stdout);
  run.finish();
}
}  // namespace

void addInfoCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "What is in a scene, and what its import ignored");
  const auto options = std::make_shared<InfoOptions>();
  options->scene.add(*command);
  options->run.addReport(*command);
  command->callback([options] { runInfo(*options); });
}

}  // namespace deltalux::cli
