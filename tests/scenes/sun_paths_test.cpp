// What the two scenes are for, checked by following the sun's own rays: over a mirror onto the things that it is to
// light, and with the moving object in their way.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <map>
#include <string>
#include <string_view>

#include "support/shared.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {
namespace {

/// A grid of parallel rays: through `corner` + s * `u` + t * `v`, along the sunlight.
struct Beam {
  Vec3 corner, u, v;
  int steps = 160;
};

class SunPaths {
 public:
  explicit SunPaths(const std::string& file)
      : scene_(loadScene({test::sourceFolder() / "scenes" / file}).scene), tracer_(tracing::makeEmbreeTracer(scene_)) {
    for (const Light& light : scene_.lights)
      if (const auto* sun = std::get_if<SunLight>(&light.emitter)) along_ = -Vec3f(sun->direction);
  }

  /// Of the rays that meet a polished surface of `mirror` first: how many, under "", and how many by the first surface
  /// that they meet next, under the top part of its name.
  std::map<std::string, int> landings(const Beam& beam, std::string_view mirror) const {
    std::map<std::string, int> counts;
    for (int i = 0; i < beam.steps; ++i)
      for (int j = 0; j < beam.steps; ++j) {
        const double s = (i + 0.5) / beam.steps, t = (j + 0.5) / beam.steps;
        tracing::Ray ray;
        ray.origin = Vec3f(beam.corner + s * beam.u + t * beam.v);
        ray.direction = along_;
        const tracing::Hit first = firstOpaque(ray);
        if (!first || !isPolished(first) || topName(first) != mirror) continue;
        ++counts[""];
        tracing::Ray thrown = reflected(ray, first);
        const tracing::Hit next = firstOpaque(thrown);
        if (next) ++counts[topName(next)];
      }
    return counts;
  }

  void translate(std::string_view object, const Vec3& by) {
    Mat4 matrix(1.0);
    matrix[3] = glm::dvec4(by, 1.0);
    for (const ObjectId id : findObjects(scene_, object))
      for (const PrimitiveId p : primitivesOf(scene_, id)) {
        Shape& shape = scene_.primitives[p.index()].shape;
        shape = *transformed(shape, matrix);
      }
    tracer_ = tracing::makeEmbreeTracer(scene_);
  }

 private:
  /// Takes the ray's origin past the panes that it crosses.
  tracing::Hit firstOpaque(tracing::Ray& ray) const {
    for (tracing::Hit hit = tracer_->closestHit(ray); hit; hit = tracer_->closestHit(ray)) {
      if (scene_.materialOf(hit.primitive).name != "window_glass") return hit;
      ray.origin = tracing::offsetOrigin(tracing::at(ray, hit.t), hit.normal, ray.direction);
    }
    return {};
  }

  static tracing::Ray reflected(const tracing::Ray& ray, const tracing::Hit& hit) {
    tracing::Ray out;
    out.direction = ray.direction - 2.0f * glm::dot(ray.direction, hit.normal) * hit.normal;
    out.origin = tracing::offsetOrigin(tracing::at(ray, hit.t), hit.normal, out.direction);
    return out;
  }

  bool isPolished(const tracing::Hit& hit) const {
    const std::string& material = scene_.materialOf(hit.primitive).name;
    return material == "silvering" || material == "cladding";
  }

  std::string topName(const tracing::Hit& hit) const {
    const std::string& name = scene_[scene_[hit.primitive].object].name;
    return name.substr(0, name.find('.'));
  }

  Scene scene_;
  std::unique_ptr<tracing::RayTracer> tracer_;
  Vec3f along_{0.0f};
};

double share(const std::map<std::string, int>& counts, const std::string& name) {
  const auto found = counts.find(name);
  return found == counts.end() ? 0.0 : static_cast<double>(found->second) / counts.at("");
}

// Just outside the openings of the lodge's windows.
const Beam kBedroomWindow{{5, 0.2, 0.9}, {0, 1.8, 0}, {0, 0, 1.5}};
const Beam kPictureWindow{{-3.4, -0.4, 0.9}, {3.2, 0, 0}, {0, 0, 1.6}};
const Beam kBathWindow{{5, 5.3, 1.3}, {0, 1.5, 0}, {0, 0, 1.2}};

TEST(LodgeSun, CrossesTheBedroomOverTheDressersMirror) {
  const std::map<std::string, int> counts = SunPaths("lodge/morning.rad").landings(kBedroomWindow, "dresser_mirror");
  EXPECT_GT(counts.at(""), 5000);  // about a third of the rays
  EXPECT_GT(share(counts, "east_wall"), 0.15);
  EXPECT_GT(share(counts, "chest"), 0.1);
  EXPECT_GT(share(counts, "armchair"), 0.15);
}

TEST(LodgeSun, ContainerMovesIntoTheBeam) {
  SunPaths paths("lodge/morning.rad");
  const std::map<std::string, int> before = paths.landings(kBedroomWindow, "dresser_mirror");
  EXPECT_EQ(share(before, "container"), 0);
  for (int step = 1; step <= 4; ++step) {
    paths.translate("container", {0, 0.25, 0});
    const std::map<std::string, int> now = paths.landings(kBedroomWindow, "dresser_mirror");
    // It takes light on its way to the mirror, and on its way from the mirror.
    const double taken = 1.0 - (1.0 - share(now, "container")) * now.at("") / before.at("");
    EXPECT_GT(taken, step == 1 ? 0.01 : 0.05) << "step " << step;
  }
}

TEST(LodgeSun, ReachesThePianoOverTheTallMirror) {
  const std::map<std::string, int> counts = SunPaths("lodge/morning.rad").landings(kPictureWindow, "hall_mirror");
  EXPECT_GT(counts.at(""), 1000);
  EXPECT_GT(share(counts, "piano"), 0.3);
}

TEST(LodgeSun, GrazesTheBathroomMirrorOntoTheWestWall) {
  const std::map<std::string, int> counts = SunPaths("lodge/morning.rad").landings(kBathWindow, "basin_mirror");
  EXPECT_GT(counts.at(""), 1000);
  EXPECT_GT(share(counts, "partition_bath"), 0.6);
}

// The whole front of the clad building, as the sun sees it.
const Beam kTower{{0, -24, 5}, {0, 46, 0}, {0, 0, 20}, 240};

TEST(StreetSun, IsThrownOntoTheWestRowAndTheStreet) {
  const std::map<std::string, int> counts = SunPaths("street/day.rad").landings(kTower, "tower");
  EXPECT_GT(counts.at(""), 20000);
  EXPECT_GT(share(counts, "west"), 0.3);
  EXPECT_GT(share(counts, "roadway") + share(counts, "pavement_west"), 0.05);
}

TEST(StreetSun, CarStandsInTheThrownLightInEveryPosition) {
  SunPaths paths("street/day.rad");
  for (int position = 0; position <= 4; ++position) {
    EXPECT_GT(share(paths.landings(kTower, "tower"), "car"), 0.002) << "position " << position;
    paths.translate("car", {0, 6.5, 0});
  }
}

}  // namespace
}  // namespace deltalux
