#include "scene_options.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "interrupt.hpp"

namespace deltalux::cli {

namespace {
struct Placement {
  std::string file;
  Vec3 position{0};
};

/// Splits FILE@x,y,z at its last '@'; nullopt when it does not read so.
std::optional<Placement> parsePlacement(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || at == 0) return std::nullopt;
  Placement placement{text.substr(0, at), Vec3(0)};
  const char* cursor = text.data() + at + 1;
  const char* const end = text.data() + text.size();
  for (int axis = 0; axis < 3; ++axis) {
    const auto [next, error] = std::from_chars(cursor, end, placement.position[axis]);
    if (error != std::errc() || !std::isfinite(placement.position[axis])) return std::nullopt;
    if (axis < 2 && (next == end || *next != ',')) return std::nullopt;
    cursor = axis < 2 ? next + 1 : next;
  }
  return cursor == end ? std::optional(placement) : std::nullopt;
}

std::string checkPlacement(const std::string& text) {
  return parsePlacement(text) ? "" : fmt::format("'{}' should read FILE@x,y,z, e.g. lamp.ies@1,2.5,3", text);
}

/// Aimed against the scene's up, the 0 plane along +x, or along +y where up is x.
glm::dmat3 hangingFrame(const Vec3& up) {
  const Vec3 axis = glm::normalize(up);
  const Vec3 hint = std::abs(axis.x) < 0.9 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 zeroPlane = glm::normalize(hint - glm::dot(hint, axis) * axis);
  return {zeroPlane, glm::cross(axis, zeroPlane), axis};
}

/// The file's name, made different from every light's: "flood", "flood-2" ...
std::string freeLightName(const Scene& scene, const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  std::string name = stem;
  for (int i = 2; !findLights(scene, name).empty(); ++i) name = fmt::format("{}-{}", stem, i);
  return name;
}

void addLuminaire(Scene& scene, const Placement& placement) {
  PhotometricLight light;
  light.position = placement.position;
  light.frame = hangingFrame(scene.up);
  light.photometry = std::make_shared<const Photometry>(loadPhotometry(placement.file));
  // I / d^2 is W/m2 for d in metres; transport measures d in scene units.
  light.scale = Rgb(static_cast<float>(1.0 / (scene.metresPerUnit * scene.metresPerUnit)));
  scene.lights.push_back({freeLightName(scene, placement.file), std::move(light), Rgb(1.0f)});
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
  app.add_option("--ies", luminaires, "Add a measured light (IES LM-63), aimed straight down; may be repeated")
      ->type_name("FILE@x,y,z")
      ->allow_extra_args(false)
      ->check(checkPlacement);
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

ImportedScene SceneOptions::load(Run& run) const {
  requireEffect();
  const double begin = run.elapsed();
  run.report.scene = fmt::format("{}", fmt::join(files, " "));
  ImportedScene imported = loadScene({files.begin(), files.end()}, import);
  for (const std::string& luminaire : luminaires) addLuminaire(imported.scene, *parsePlacement(luminaire));
  for (const std::string& warning : imported.report.warnings) run.say("warning: " + warning);
  run.report.times.import = run.elapsed() - begin;
  run.report.sceneStats = sceneStats(imported.scene);
  run.report.sceneStats.ignored = imported.report.ignored;
  throwIfInterrupted();
  return imported;
}

}  // namespace deltalux::cli
