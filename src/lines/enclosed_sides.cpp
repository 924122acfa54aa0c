#include "lines/enclosed_sides.hpp"

#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "lines/scene_widths.hpp"
#include "scene/light_sampling.hpp"
#include "scene/nominal_scale.hpp"
#include "scene/stops_light.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::lines {

namespace {

constexpr std::uint64_t kWalkKey = 0x77616c6b73ull, kAskKey = 0x6173ull;  // [key]
constexpr std::size_t kMostWalkSteps = 8;                                 // that are kept one by one [task]

/// Many short steps are as well told by the box that they run in.
void putIntoBox(LightWalks& walks) {
  if (walks.steps.size() <= kMostWalkSteps) return;
  for (const LineSegment& s : walks.steps) {
    if (!std::isfinite(s.length)) return;
    const Vec3f end = s.from + s.length * s.direction;
    walks.box.extend({glm::min(s.from, end), glm::max(s.from, end)});
  }
  walks.steps.clear();
}

/// Looks for light along diffuse walks.
class LightSearch {
 public:
  LightSearch(const hierarchy::Elements& elements, const LineTracer& tracer)
      : elements_(elements), tracer_(tracer), scene_(tracer.scene()), lights_(scene_, scene::nominalScales(scene_)) {
    const std::vector<Rgb> nominal = scene::nominalScales(scene_);
    for (std::size_t i = 0; i < scene_.lights.size(); ++i) {
      if (isBlack(nominal[i])) continue;
      const bool dome = std::holds_alternative<DomeLight>(scene_.lights[i].emitter);
      if (!dome) asked_.emplace_back(i);
      outside_ = outside_ || dome || std::holds_alternative<SunLight>(scene_.lights[i].emitter);
    }
  }

  /// Enclosed: nothing of it is found from the side, and the mean distance of the walks' steps is below `hollow`.
  LightWalks from(hierarchy::ElementId side, double hollow, std::uint64_t& rays) const {
    LightWalks walks;
    walks.enclosed = encloses(side, hollow, walks, rays);
    if (!walks.enclosed) walks.asked = {};
    putIntoBox(walks);
    walks.steps.shrink_to_fit(), walks.asked.shrink_to_fit();
    return walks;
  }

  /// Whether one of these lights is seen from where walks that found none have asked for it.
  bool findsAny(std::span<const char> moved, hierarchy::ElementId side, LightWalks& walks, std::uint64_t& rays) const {
    for (std::size_t i = 0; i < walks.asked.size(); ++i) {
      const ToLight to = toLight(elements_.key[side.index()], i);
      if (moved[to.light.index()] && sees(to, walks.asked[i], walks, rays)) return true;
    }
    putIntoBox(walks);
    return false;
  }

 private:
  /// How far walks go: narrow hollows are told by it.
  struct Lengths {
    double sum = 0;
    int steps = 0;

    double width() const { return steps > 0 ? sum / steps : 0; }
  };

  /// A light, and where on it.
  struct ToLight {
    LightId light;
    Vec2 at;
  };

  bool encloses(hierarchy::ElementId side, double hollow, LightWalks& walks, std::uint64_t& rays) const {
    const hierarchy::LeafSequence points(elements_, scene_, side);
    Lengths lengths;
    for (int walk = 0; walk < deltalux::tuning::kPilots; ++walk)
      if (findsLight(points, walk, 0, hollow, lengths, walks, rays)) return false;
    const double width = std::sqrt(double(elements_.shape(side).area));
    // Of a wider one a rim may look out, at which no walk has begun.
    if (lengths.steps == 0 || !(lengths.width() < hollow && width < deltalux::tuning::kPilots * lengths.width()))
      return false;
    // Most of a rounded edge or a ball may lie inside of what it rounds: walks from where something far is seen.
    Lengths far;  // first steps are chosen for going far, and tell nothing
    for (int walk = 0; walk < deltalux::tuning::kPilots; ++walk)
      if (findsLight(points, farthest(points, walk + 1, walks, rays), 1, hollow, far, walks, rays)) return false;
    return far.width() < hollow;
  }

  Rng randomOf(const hierarchy::LeafSequence& points, int walk) const {
    return Rng(combineKeys(points.key(), kWalkKey), static_cast<std::uint64_t>(walk));
  }
  LineEnd step(const hierarchy::PatchPoint& x, Rng& random, LightWalks& walks, std::uint64_t& rays) const {
    const double u = random.uniform(), v = random.uniform();
    const Vec3f w(cosineDirection(Frame(Vec3(x.normal)), u, v));
    ++rays;
    return tracer_.follow(x.position, x.normal, w, Rng(random.bits()), &walks.steps);
  }

  /// Of kFewRays walks in a row, the one whose first step goes farthest.
  int farthest(const hierarchy::LeafSequence& points, int row, LightWalks& walks, std::uint64_t& rays) const {
    int best = row * deltalux::tuning::kFewRays;
    double most = -1;
    for (int walk = best; walk < (row + 1) * deltalux::tuning::kFewRays; ++walk) {
      Rng random = randomOf(points, walk);
      const LineEnd end = step(points.point(static_cast<std::uint32_t>(walk)), random, walks, rays);
      const double distance = end.termination == LineTermination::Escaped ? kInfinity
                              : end.termination == LineTermination::Ended ? double(end.distance)
                                                                          : 0;
      if (distance > most) most = distance, best = walk;
    }
    return best;
  }

  /// A walk finds light, or room enough for it: by the lengths of its steps from the one numbered `counted` on.
  bool findsLight(const hierarchy::LeafSequence& points, int walk, int counted, double hollow, Lengths& lengths,
                  LightWalks& walks, std::uint64_t& rays) const {
    Rng random = randomOf(points, walk);
    hierarchy::PatchPoint x = points.point(static_cast<std::uint32_t>(walk));
    for (int bounce = 0; bounce < deltalux::tuning::kPilots; ++bounce) {
      const LineEnd end = step(x, random, walks, rays);
      if (!asked_.empty()) {
        const ToLight to = toLight(points.key(), walks.asked.size());
        walks.asked.push_back(x);
        if (sees(to, x, walks, rays)) return walks.found = to.light, true;
      }
      if (end.termination == LineTermination::Escaped && outside_) return true;
      if (end.termination != LineTermination::Ended) return false;
      if (bounce >= counted) lengths.sum += end.turned ? 0 : end.distance, ++lengths.steps;
      if (lengths.steps >= deltalux::tuning::kFewRays && !(lengths.width() < hollow)) return true;
      const Material& material = scene_.materialOf(end.side.primitive);
      if (sendsLight(material) && (end.side.front || material.emission->bothSides)) return true;
      const bool through = !isBlack(diffuseTransmittance(material)) && random.uniform() < 0.5;
      x = {end.position, through ? -end.normal : end.normal};
    }
    return false;
  }

  /// Of the lights that are not all around, the one that the walks of a side ask for the so manieth time.
  ToLight toLight(std::uint64_t key, std::size_t time) const {
    Rng random(combineKeys(key, kAskKey), time);
    const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(asked_.size()));
    const double u = random.uniform(), v = random.uniform();
    return {asked_[k], {u, v}};
  }
  /// A shadow ray.
  bool sees(const ToLight& to, const hierarchy::PatchPoint& x, LightWalks& walks, std::uint64_t& rays) const {
    const auto s = lights_.sample(to.light, Vec3(x.position), to.at);
    if (!s || !(glm::dot(s->direction, Vec3(x.normal)) > 0) || isBlack(s->radiance)) return false;
    ++rays;
    const tracing::Ray ray = tracing::shadowRay(Vec3(x.position), Vec3(x.normal), s->direction, s->distance, s->normal);
    // What is beyond the first surface that stops light does not matter.
    const tracing::Hit hit = tracer_.tracer().closestHit(ray);
    const bool stopped = hit && scene::stopsLight(scene_.materialOf(hit.primitive));
    walks.steps.push_back({ray.origin, ray.direction, stopped ? hit.t : static_cast<float>(s->distance)});
    return !stopped && (!hit || !isBlack(tracer_.tracer().transmittance(ray)));
  }

  const hierarchy::Elements& elements_;
  const LineTracer& tracer_;
  const Scene& scene_;
  scene::LightSampler lights_;
  std::vector<LightId> asked_;
  bool outside_ = false;  // whether there is light at infinity
};

}  // namespace

std::uint64_t walkForLight(const hierarchy::Elements& elements, const LineTracer& tracer, const WalksHold& hold,
                           std::span<const char> movedLights, std::vector<LightWalks>& walks) {
  constexpr std::size_t kBlock = 16;  // [task]
  const Scene& scene = tracer.scene();
  const double hollow = widthsOf(scene, elements.sceneBox).hollow;
  const LightSearch search(elements, tracer);
  walks.resize(elements.size());
  return parallelSum<std::uint64_t>(elements.inputs.size(), kBlock, [&](std::size_t i) {
    std::uint64_t own = 0;
    const hierarchy::ElementId side = elements.inputs[i];
    if (!elements.receives(side)) return own;
    LightWalks& of = walks[side.index()];
    // What has found another light has found one, whichever it would find before.
    const auto findsNow = [&] {
      return of.enclosed ? search.findsAny(movedLights, side, of, own)
                         : of.found.valid() && movedLights[of.found.index()];
    };
    if (!hold(side, of) || (!movedLights.empty() && findsNow())) of = search.from(side, hollow, own);
    return own;
  });
}

}  // namespace deltalux::lines
