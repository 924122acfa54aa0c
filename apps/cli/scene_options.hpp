#pragma once
// SCENE and how it is imported, the same for every command that takes one.
#include <CLI/CLI.hpp>
#include <deltalux/daylight.hpp>
#include <deltalux/io.hpp>
#include <optional>
#include <string>
#include <vector>

#include "run_options.hpp"

namespace deltalux::cli {

struct SceneOptions {
  std::vector<std::string> files;
  std::vector<std::string> luminaires;  // FILE@x,y,z
  ImportSettings import;
  std::string sky, when, where;  // of a daylight; empty for none
  double north = 0, ground = Daylighting().groundReflectance;

  void add(CLI::App&);

  /// Reads the scene, adds the luminaires, notes names, times and statistics in the run's report, and passes the
  /// import's warnings on. Throws InputError.
  ImportedScene load(Run&) const;
  std::vector<Luminaire> hung() const;
  /// What --sky, --when and --where say together.
  std::optional<Daylighting> daylight() const;
  /// An option that this scene's format does not heed is a mistake worth telling.
  void requireEffect() const;
  /// The names of its options.
  static std::vector<const char*> names() {
    return {"--ies", "--metres-per-unit", "--efficacy", "--sky", "--when", "--where", "--north", "--ground"};
  }

 private:
  CLI::Option* metresOption_ = nullptr;
  CLI::Option* efficacyOption_ = nullptr;
  std::vector<CLI::Option*> daylightOptions_;  // that say nothing without --sky
};

/// What SceneOptions::load does, of what they say.
ImportedScene importScene(Run&, const std::vector<std::filesystem::path>& files, const std::vector<Luminaire>&,
                          const ImportSettings&, const std::optional<Daylighting>&);

/// What a scene holds; what its import ignored is not known to it.
SceneStats sceneStats(const Scene&);

}  // namespace deltalux::cli
