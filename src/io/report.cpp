#include <sys/resource.h>

#include <deltalux/report.hpp>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"

namespace deltalux {

namespace {
using Json = nlohmann::ordered_json;

Json json(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

Json json(const SceneStats& s) {
  return {{"objects", s.objects},
          {"primitives", s.primitives},
          {"polygons_if_tessellated", s.polygonsIfTessellated},
          {"lights", s.lights},
          {"ignored", Json(s.ignored.empty() ? Json::object() : Json(s.ignored))}};
}

Json json(const PhaseTimes& t) {
  return {{"import", t.import}, {"hierarchy", t.hierarchy}, {"refine", t.refine},     {"visibility", t.visibility},
          {"gather", t.gather}, {"particles", t.particles}, {"textures", t.textures}, {"total", t.total}};
}

Json json(const WorkCounts& c) {
  return {{"elements", c.elements},
          {"leaf_elements", c.leafElements},
          {"links", c.links},
          {"links_ds", c.linksDs},
          {"lines", c.lines},
          {"particles", c.particles},
          {"impacts", c.impacts},
          {"rays_visibility", c.raysVisibility},
          {"rays_particles", c.raysParticles},
          {"iterations", c.iterations},
          {"caustic_textures", c.causticTextures},
          {"caustic_texture_mean_size", c.causticTextureMeanSize}};
}

Json json(const MemoryBytes& m) {
  return {{"elements", m.elements}, {"links", m.links},       {"lines", m.lines},     {"particles", m.particles},
          {"octree", m.octree},     {"textures", m.textures}, {"peak_rss", m.peakRss}};
}

Json json(const ErrorEstimate& e) {
  return {{"asked", e.asked}, {"estimated_median", json(e.estimatedMedian)}, {"estimated_p95", json(e.estimatedP95)}};
}

Json json(const EnergyLedger& e) {
  return {{"emitted_w", json(e.emittedW)},
          {"absorbed_w", json(e.absorbedW)},
          {"escaped_w", json(e.escapedW)},
          {"unsettled_w", json(e.unsettledW)}};
}

Json json(const StepReport& s) {
  Json step{{"op", s.op},
            {"object", s.object},
            {"time_s", json(s.times)},
            {"links_visited", s.linksVisited},
            {"links_changed", s.linksChanged},
            {"leaves_changed", s.leavesChanged},
            {"particles_retraced", s.particlesRetraced},
            {"particles_total", s.particlesTotal},
            {"textures_rebuilt", s.texturesRebuilt},
            {"rays", s.rays},
            {"deferred", s.deferred}};
  if (s.staleW) step["stale_w"] = *s.staleW;
  return step;
}

Json json(const CheckReport& c) {
  return {{"solve_s", c.solveS},
          {"irradiance_rel_diff", {{"median", c.medianRelDiff}, {"p95", c.p95RelDiff}, {"max", c.maxRelDiff}}},
          {"mesh_identical", c.meshIdentical},
          {"lines_identical", c.linesIdentical},
          {"particles_identical", c.particlesIdentical}};
}

Json json(const CausticReport& c) {
  Json textures = Json::array();
  for (const CausticReport::Texture& t : c.textures)
    textures.push_back({{"width", t.width}, {"height", t.height}, {"particles", t.particles}});
  return {{"surface", c.surface},
          {"primitive", c.primitive},
          {"side", c.front ? "front" : "back"},
          {"textures", std::move(textures)},
          {"flux_w", c.fluxW}};
}

Json json(const ReferenceReport& r) { return {{"paths", r.paths}, {"rays", r.rays}, {"seconds", r.seconds}}; }
}  // namespace

std::string toJson(const RunReport& report) {
  Json steps = Json::array();
  for (const StepReport& step : report.steps) steps.push_back(json(step));
  Json document{{"command", report.command},
                {"version", report.version},
                {"scene", report.scene},
                {"threads", report.threads},
                {"seed", report.seed},
                {"scene_stats", json(report.sceneStats)},
                {"time_s", json(report.times)},
                {"counts", json(report.counts)},
                {"memory_bytes", json(report.memory)},
                {"error", json(report.error)},
                {"energy", json(report.energy)},
                {"steps", std::move(steps)},
                {"check", report.check ? json(*report.check) : Json(nullptr)}};
  for (const CausticReport& c : report.caustics) document["caustics"].push_back(json(c));
  if (report.reference) document["reference"] = json(*report.reference);
  // A file name need not be UTF-8; the report is.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void writeReport(const std::filesystem::path& path, const RunReport& report) { io::writeFile(path, toJson(report)); }

std::uint64_t peakResidentBytes() {
  rusage usage{};
  if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace deltalux
