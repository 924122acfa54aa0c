// Which sides of surfaces face hollows that no light reaches: the insides of logs, legs and cushions.
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "lines/cover.hpp"
#include "lines/follow_line.hpp"
#include "lines/tuning.hpp"
#include "scene/light_sampling.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::lines {

namespace {

constexpr std::uint64_t kWalkKey = 0x77616c6b73ull;

/// Looks for light along diffuse walks.
class LightSearch {
 public:
  LightSearch(const hierarchy::Elements& elements, const LineTracer& tracer)
      : elements_(elements), tracer_(tracer), scene_(tracer.scene()), lights_(scene_) {
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      if (isBlack(scene_.lights[i].scale)) continue;
      const bool dome = std::holds_alternative<DomeLight>(scene_.lights[i].emitter);
      if (!dome) asked_.emplace_back(i);
      outside_ = outside_ || dome || std::holds_alternative<SunLight>(scene_.lights[i].emitter);
    }
  }

  /// Whether nothing of it is found from the side, and the mean distance of the walks' steps is below `hollow`.
  bool encloses(hierarchy::ElementId side, double hollow, std::uint64_t& rays) const {
    const hierarchy::LeafSequence points(elements_, scene_, side);
    double length = 0;
    int steps = 0;
    for (int walk = 0; walk < tuning::kWalks; ++walk) {
      Rng random(combineKeys(points.key(), kWalkKey), static_cast<std::uint64_t>(walk));
      hierarchy::PatchPoint x = points.point(static_cast<std::uint32_t>(walk));
      for (int bounce = 0; bounce < tuning::kBounces; ++bounce) {
        if (sees(x, random, rays)) return false;
        const double u = random.uniform(), v = random.uniform();
        const Vec3f w(cosineDirection(Frame(Vec3(x.normal)), u, v));
        const LineEnd end = tracer_.follow(x.position, x.normal, w, Rng(random.bits()));
        ++rays;
        if (end.fate == LineFate::Escaped && outside_) return false;
        if (end.fate != LineFate::Ended) break;
        length += end.turned ? 0 : end.distance, ++steps;
        if (steps >= tuning::kFirstSteps && !(length < hollow * steps)) return false;
        const Material& material = scene_.materialOf(end.side.primitive);
        if (sendsLight(material) && (end.side.front || material.emission->bothSides)) return false;
        const bool through = !isBlack(diffuseTransmittance(material)) && random.uniform() < 0.5;
        x = {end.position, through ? -end.normal : end.normal};
      }
    }
    const double width = std::sqrt(double(elements_.shape(side).area));
    return steps > 0 && length < hollow * steps && width * steps < tuning::kWidestHollow * length;
  }

 private:
  /// A shadow ray to one of the lights that are not all around.
  bool sees(const hierarchy::PatchPoint& x, Rng& random, std::uint64_t& rays) const {
    if (asked_.empty()) return false;
    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(asked_.size()));
    const double u = random.uniform(), v = random.uniform();
    const auto s = lights_.sample(asked_[k], Vec3(x.position), {u, v});
    if (!s || !(glm::dot(s->direction, Vec3(x.normal)) > 0) || isBlack(s->radiance)) return false;
    ++rays;
    return !isBlack(tracer_.tracer().transmittance(
        tracing::shadowRay(Vec3(x.position), Vec3(x.normal), s->direction, s->distance, s->normal)));
  }

  const hierarchy::Elements& elements_;
  const LineTracer& tracer_;
  const Scene& scene_;
  scene::LightSampler lights_;
  std::vector<LightId> asked_;
  bool outside_ = false;  // whether there is light at infinity
};

}  // namespace

std::vector<char> enclosedSides(const hierarchy::Elements& elements, const LineTracer& tracer, std::uint64_t& rays) {
  constexpr std::size_t kBlock = 16;
  const Scene& scene = tracer.scene();
  const double hollow =
      std::min(tuning::kHollow / scene.metresPerUnit, tuning::kHollowOfScene * elements.sceneBox.diagonal());
  const LightSearch search(elements, tracer);
  std::vector<char> enclosed(elements.size(), 0);
  rays += parallelSum<std::uint64_t>(elements.inputs.size(), kBlock, [&](std::size_t i) {
    std::uint64_t own = 0;
    const hierarchy::ElementId side = elements.inputs[i];
    if (elements.receives(side)) enclosed[side.index()] = search.encloses(side, hollow, own);
    return own;
  });
  return enclosed;
}

}  // namespace deltalux::lines
