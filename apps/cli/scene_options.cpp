#include "scene_options.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "dark_scene.hpp"
#include "interrupt.hpp"

namespace deltalux::cli {

namespace {
/// Splits FILE@x,y,z at its last '@'; nullopt when it does not read so.
std::optional<Luminaire> parseLuminaire(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0) return std::nullopt;
  Luminaire luminaire{text.substr(0, at), Vec3(0)};
  const char* cursor = text.data() + at + 1;
  const char* const end = text.data() + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [next, error] = std::from_chars(cursor, end, luminaire.position[axis]);
    if (error != std::errc() || !std::isfinite(luminaire.position[axis])) return std::nullopt;
    if (axis < 2 && (next == end || *next != ',')) return std::nullopt;
    cursor = axis < 2 ? next + 1 : next;
  }
  return cursor == end ? std::optional(luminaire) : std::nullopt;
}

std::string checkLuminaire(const std::string& text) {
  return parseLuminaire(text) ? "" : fmt::format("'{}' should read FILE@x,y,z, e.g. lamp.ies@1,2.5,3", text);
}

bool isGltf(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace

SceneStats sceneStats(const Scene& scene) {
  SceneStats stats;
  stats.objects = scene.objects.size();
  stats.primitives = scene.primitives.size();
  stats.lights = scene.lights.size();
  for (const Primitive& primitive : scene.primitives)
    stats.polygonsIfTessellated += tessellatedPolygonCount(primitive.shape);
  return stats;
}

void SceneOptions::add(CLI::App& app) {
  app.add_option("SCENE", files, ".gltf, .glb or .obj, or .rad files in order")->required()->type_name("FILE");
  app.add_option("--ies", luminaires, "Add a measured light (IES LM-63, TM-33, EULUMDAT), aimed straight down; may be repeated")
      ->type_name("FILE@x,y,z")
      ->allow_extra_args(false)
      ->check(checkLuminaire);
  metresOption_ =
      app.add_option("--metres-per-unit", import.metresPerUnit, "Length of the unit of a .rad or .obj scene");
  metresOption_->type_name("M")->check(CLI::PositiveNumber)->capture_default_str();
  efficacyOption_ = app.add_option("--efficacy", import.luminousEfficacy,
                                   "lm/W that turn a glTF scene's candela, lux and cd/m2 into watts");
  efficacyOption_->type_name("K")->check(CLI::PositiveNumber)->capture_default_str();
}

void SceneOptions::requireEffect() const {
  const bool gltf = isGltf(files.front());
  if (gltf && metresOption_->count() > 0) throw CLI::ValidationError("--metres-per-unit: glTF scenes are in metres");
  if (!gltf && efficacyOption_->count() > 0)
    throw CLI::ValidationError("--efficacy: only glTF scenes hold photometric values");
}

std::vector<Luminaire> SceneOptions::hung() const {
  std::vector<Luminaire> result;
  for (const std::string& text : luminaires) result.push_back(*parseLuminaire(text));
  return result;
}

ImportedScene SceneOptions::load(Run& run) const {
  requireEffect();
  return importScene(run, {files.begin(), files.end()}, hung(), import);
}

ImportedScene importScene(Run& run, const std::vector<std::filesystem::path>& files,
                          const std::vector<Luminaire>& luminaires, const ImportSettings& import) {
  const double begin = run.elapsed();
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  run.report.scene = fmt::format("{}", fmt::join(names, " "));
  ImportedScene imported = loadScene(files, import);
  for (const Luminaire& luminaire : luminaires) addLuminaire(imported.scene, luminaire, &imported.report.warnings);
  for (const std::string& warning : imported.report.warnings) run.say("warning: " + warning);
  warnIfDark(imported.scene, run);
  run.report.times.import = run.elapsed() - begin;
  run.report.sceneStats = sceneStats(imported.scene);
  run.report.sceneStats.ignored = imported.report.ignored;
  throwIfInterrupted();
  return imported;
}

}  // namespace deltalux::cli
