#include <nlohmann/json.hpp>

#include <cmath>

#include "glare/sight_frame.hpp"
#include "io/atomic_file.hpp"

namespace deltalux {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }
Json triple(const Vec3& v) { return {v.x, v.y, v.z}; }

Json sourceJson(const GlareSource& s) {
  return {{"direction", triple(s.direction)},
          {"luminance_cd_m2", number(s.luminance)},
          {"solid_angle_sr", s.solidAngle},
          {"position_index", number(s.positionIndex)}};
}

Json eyeJson(const Scene& scene, const Eye& eye) {
  const glare::SightFrame f(eye);
  return {{"position", triple(eye.position + scene.origin)}, {"direction", triple(f.ahead)}, {"up", triple(f.above)}};
}

Json daylightJson(const Scene& scene, const DaylightGlare& g) {
  Json sources = Json::array();
  for (const GlareSource& s : g.sources) sources.push_back(sourceJson(s));
  return {{"eye", eyeJson(scene, g.eye)},
          {"dgp", g.probability},
          {"illuminance_lux", g.illuminance},
          {"threshold_cd_m2", g.threshold},
          {"sources", std::move(sources)}};
}

Json unifiedJson(const Scene& scene, const UnifiedGlare& g) {
  Json luminaires = Json::array();
  for (const LuminaireSeen& l : g.luminaires) {
    Json one = {{"name", l.name}};
    one.update(sourceJson(l.source));
    one["illuminance_lux"] = l.illuminance, one["small"] = l.small;
    luminaires.push_back(std::move(one));
  }
  return {{"eye", eyeJson(scene, g.eye)},
          {"ugr", number(g.rating)},
          {"background_cd_m2", g.background},
          {"luminaires", std::move(luminaires)}};
}

}  // namespace

std::string toJson(const Scene& scene, const DaylightGlare* daylight, std::span<const UnifiedGlare> unified) {
  Json all = {{"version", DELTALUX_VERSION}, {"dgp", daylight ? daylightJson(scene, *daylight) : Json()}};
  Json ugr = Json::array();
  for (const UnifiedGlare& g : unified) ugr.push_back(unifiedJson(scene, g));
  all["ugr"] = std::move(ugr);
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeGlare(const std::filesystem::path& file, const Scene& scene, const DaylightGlare* daylight,
                std::span<const UnifiedGlare> unified) {
  io::writeFile(file, toJson(scene, daylight, unified));
}

}  // namespace deltalux
