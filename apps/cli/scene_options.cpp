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

template <class Parse>
auto checkedBy(const Parse& parse, const char* example) {
  return [parse, example](const std::string& text) {
    return parse(text) ? std::string() : fmt::format("'{}' should read {}", text, example);
  };
}

constexpr double kDegree = kPi / 180;  // [defined]

/// What sun and sky come to, for a reader to find mistakes of time and place by.
std::string describe(const Daylighting& daylight, const Scene& scene) {
  const SunSighting sun = sightSun(daylight.time, daylight.place);
  double beam = 0;  // of the one sun that setDaylight() has left
  for (const Light& light : scene.lights)
    if (const auto* lit = std::get_if<SunLight>(&light.emitter))
      beam += solidAngle(*lit) * photometric(glm::dvec3(lit->radiance), scene.luminousEfficacy);
  return fmt::format("daylight: the sun {:.2f} degrees high, {:.2f} degrees from north; across its beam {:.0f} lx",
                     sun.altitude / kDegree, sun.azimuth / kDegree, beam);
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
  app.add_option("SCENE", files, ".gltf, .glb, .obj, .xml (Mitsuba) or .pbrt, or .rad files in order")
      ->required()
      ->type_name("FILE");
  app.add_option("--ies", luminaires,
                 "Add a measured light (IES LM-63, TM-33, EULUMDAT), aimed straight down; may be repeated")
      ->type_name("FILE@x,y,z")
      ->allow_extra_args(false)
      ->check(checkLuminaire);
  app.add_option("--sky", sky, "Put a daylight over the scene: a CIE standard sky, or one of two irradiances [W/m2]")
      ->type_name("cie:N|perez:DNI,DHI")
      ->check(checkedBy(parseSkyModel, "cie:N with N of 1 to 15, cie:N,LUX or perez:DNI,DHI"));
  daylightOptions_ = {
      app.add_option("--when", when, "Time of the daylight, by clocks of its place or with a zone")
          ->type_name("ISO")
          ->check(checkedBy(parseCivilTime, "2026-06-21T09:00, or with a zone 2026-06-21T09:00+02:00")),
      app.add_option("--where", where, "Its place, in degrees north and east")
          ->type_name("LAT,LON")
          ->check(checkedBy(parsePlace, "LATITUDE,LONGITUDE, e.g. 47.4,8.5")),
      app.add_option("--north", north, "Where true north lies, clockwise from the scene's +y (from -z where y is up)")
          ->type_name("DEG")
          ->check(CLI::Range(-360.0, 360.0)),
      app.add_option("--ground", ground, "Reflectance of the ground under the sky")
          ->type_name("R")
          ->check(CLI::Range(0.0, 1.0))
          ->capture_default_str()};
  metresOption_ =
      app.add_option("--metres-per-unit", import.metresPerUnit, "Length of the unit of a scene, glTF aside");
  metresOption_->type_name("M")->check(CLI::PositiveNumber)->capture_default_str();
  efficacyOption_ = app.add_option("--efficacy", import.luminousEfficacy,
                                   "lm/W that turn a glTF scene's candela, lux and cd/m2 into watts");
  efficacyOption_->type_name("K")->check(CLI::PositiveNumber)->capture_default_str();
}

void SceneOptions::requireEffect() const {
  const bool gltf = isGltf(files.front());
  if (gltf && metresOption_->count() > 0) throw CLI::ValidationError("--metres-per-unit: glTF scenes are in metres");
  if (sky.empty())
    for (const CLI::Option* option : daylightOptions_)
      if (option->count() > 0) throw CLI::ValidationError(option->get_name() + ": there is no --sky that it is about");
  if (!sky.empty() && (when.empty() || where.empty()))
    throw CLI::ValidationError("--sky " + sky + ": its sun needs --when and --where");
  if (!gltf && efficacyOption_->count() > 0)
    throw CLI::ValidationError("--efficacy: only glTF scenes hold photometric values");
}

std::vector<Luminaire> SceneOptions::hung() const {
  std::vector<Luminaire> result;
  for (const std::string& text : luminaires) result.push_back(*parseLuminaire(text));
  return result;
}

std::optional<Daylighting> SceneOptions::daylight() const {
  if (sky.empty()) return std::nullopt;
  return Daylighting{parseSkyModel(sky).value(), parseCivilTime(when).value(), parsePlace(where).value(), north,
                     ground};
}

ImportedScene SceneOptions::load(Run& run) const {
  requireEffect();
  return importScene(run, {files.begin(), files.end()}, hung(), import, daylight());
}

ImportedScene importScene(Run& run, const std::vector<std::filesystem::path>& files,
                          const std::vector<Luminaire>& luminaires, const ImportSettings& import,
                          const std::optional<Daylighting>& daylight) {
  const double begin = run.elapsed();
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  run.report.scene = fmt::format("{}", fmt::join(names, " "));
  ImportedScene imported = loadScene(files, import);
  for (const Luminaire& luminaire : luminaires) addLuminaire(imported.scene, luminaire, &imported.report.warnings);
  if (daylight) {
    const std::size_t replaced = setDaylight(imported.scene, *daylight);
    if (replaced > 0)
      imported.report.warnings.push_back(
          fmt::format("--sky takes the place of {} suns, skies and backdrops", replaced));
    run.say(describe(*daylight, imported.scene));
  }
  for (const std::string& warning : imported.report.warnings) run.say("warning: " + warning);
  warnIfDark(imported.scene, run);
  run.report.times.import = run.elapsed() - begin;
  run.report.sceneStats = sceneStats(imported.scene);
  run.report.sceneStats.ignored = imported.report.ignored;
  throwIfInterrupted();
  return imported;
}

}  // namespace deltalux::cli
