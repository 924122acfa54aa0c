#include <gtest/gtest.h>

#include <deltalux/report.hpp>
#include <nlohmann/json.hpp>

namespace deltalux {
namespace {

using Json = nlohmann::ordered_json;
using Keys = std::vector<std::string>;

Keys keysOf(const Json& object) {
  Keys keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

TEST(Report, HasTheKeysOfTheContract) {
  RunReport report;
  report.steps.emplace_back();
  report.check.emplace();
  const Json json = Json::parse(toJson(report));
  EXPECT_EQ(keysOf(json), (Keys{"command", "version", "scene", "threads", "seed", "scene_stats", "time_s", "counts",
                                "memory_bytes", "error", "energy", "steps", "check"}));
  EXPECT_EQ(keysOf(json["scene_stats"]),
            (Keys{"objects", "primitives", "polygons_if_tessellated", "lights", "ignored"}));
  const Keys times{"import", "hierarchy", "refine", "visibility", "gather", "particles", "textures", "total"};
  EXPECT_EQ(keysOf(json["time_s"]), times);
  EXPECT_EQ(keysOf(json["counts"]),
            (Keys{"elements", "leaf_elements", "links", "links_ds", "lines", "particles", "impacts", "rays_visibility",
                  "rays_particles", "iterations", "caustic_textures", "caustic_texture_mean_size"}));
  EXPECT_EQ(keysOf(json["memory_bytes"]),
            (Keys{"elements", "links", "lines", "particles", "octree", "textures", "peak_rss"}));
  EXPECT_EQ(keysOf(json["error"]), (Keys{"asked", "estimated_median", "estimated_p95"}));
  EXPECT_EQ(keysOf(json["energy"]), (Keys{"emitted_w", "absorbed_w", "escaped_w", "unsettled_w"}));
  const Json& step = json["steps"][0];
  EXPECT_EQ(keysOf(step), (Keys{"op", "object", "time_s", "links_visited", "links_changed", "leaves_changed",
                                "particles_retraced", "particles_total", "textures_rebuilt", "rays", "deferred"}));
  EXPECT_EQ(keysOf(step["time_s"]), times);
  EXPECT_EQ(keysOf(json["check"]),
            (Keys{"solve_s", "irradiance_rel_diff", "mesh_identical", "lines_identical", "particles_identical"}));
  EXPECT_EQ(keysOf(json["check"]["irradiance_rel_diff"]), (Keys{"median", "p95", "max"}));
}

TEST(Report, KeepsValuesAndSaysNullForWhatWasNotMeasured) {
  RunReport report;
  report.command = "info";
  report.scene = "a.rad \xff";  // not UTF-8
  report.seed = 0xffffffffffffffffull;
  report.sceneStats.ignored = {{"colorpict", 3}};
  report.energy.emittedW = 12.5;
  report.times.total = 0.25;
  const Json json = Json::parse(toJson(report));
  EXPECT_EQ(json["command"], "info");
  EXPECT_EQ(json["seed"], 0xffffffffffffffffull);
  EXPECT_EQ(json["scene_stats"]["ignored"]["colorpict"], 3);
  EXPECT_EQ(json["energy"]["emitted_w"], 12.5);
  EXPECT_TRUE(json["energy"]["escaped_w"].is_null());
  EXPECT_EQ(json["time_s"]["total"], 0.25);
  EXPECT_TRUE(json["check"].is_null());
  EXPECT_TRUE(json["steps"].empty() && json["steps"].is_array());
  EXPECT_TRUE(Json::parse(toJson({}))["scene_stats"]["ignored"].is_object());
}

TEST(Report, PeakResidentBytesAreOurs) {
  EXPECT_GT(peakResidentBytes(), 1u << 20);
  EXPECT_LT(peakResidentBytes(), std::uint64_t{1} << 40);
}

}  // namespace
}  // namespace deltalux
