#include "radiosity/visibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/random.hpp"
#include "hierarchy/direction_window.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

struct Sample {
  Ray ray;
  double weight = 0;         // not above 0: the points do not face each other
  std::size_t quadrant = 0;  // of the receiver
};

/// A link's sample, by its numbers.
Sample sampleOf(const Elements& elements, const Scene& scene, ElementId receiver, ElementId sender,
                const std::array<double, 4>& u) {
  const PatchPoint x = samplePoint(elements, scene, receiver, u[0], u[1]);
  Sample s;
  s.quadrant = (u[0] < 0.5 ? 0u : 1u) + (u[1] < 0.5 ? 0u : 2u);
  if (elements.isDistant(sender)) {
    const Vec3f w = directionOf(elements, scene, sender, u[2], u[3]);
    s.weight = pointKernel(elements, scene, x.position, x.normal, sender, w, Vec3f(0.0f));
    s.ray.origin = offsetOrigin(x.position, x.normal, w);
    s.ray.direction = w;
    return s;
  }
  const PatchPoint y = samplePoint(elements, scene, sender, u[2], u[3]);
  s.weight = elements.isPoint(sender) || elements.isPatch(sender)
                 ? pointKernel(elements, scene, x.position, x.normal, sender, y.position, y.normal)
                 : std::max(0.0f, glm::dot(x.normal, y.position - x.position)) *
                       std::max(0.0f, glm::dot(y.normal, x.position - y.position));
  if (elements.isCluster(sender)) {
    const Vec3f between = y.position - x.position;
    const double squared = glm::dot(between, between);
    s.weight = squared > 0 ? s.weight / (squared * squared) : 0.0;
  }
  if (s.weight > 0) s.ray = segment(x.position, x.normal, y.position, y.normal);
  return s;
}

/// Whether the ray of a sample, by its numbers, may meet something moving: told by what its points are on, down from
/// the ends of the link.
bool mayMeet(const Elements& elements, const Scene& scene, ElementId receiver, ElementId sender,
             std::array<double, 4> u, const SpaceChange& space) {
  const bool distant = elements.isDistant(sender);
  const Vec3f w = distant ? directionOf(elements, scene, sender, u[2], u[3]) : Vec3f(0.0f);
  for (;;) {
    const ElementGeometry &r = elements.shape(receiver), &s = elements.shape(sender);
    if (distant ? !space.meetsBeam(r, w, 0.0f) : !space.meets(r.center, r.radius, s.center, s.radius)) return false;
    const bool split = elements.isCluster(receiver), other = elements.isCluster(sender);
    if (!split && !other) return true;
    const bool atReceiver = split && (!other || r.radius >= s.radius);
    ElementId& end = atReceiver ? receiver : sender;
    end = childByArea(elements, end, atReceiver ? u[0] : u[2]);
    if (!end.valid()) return true;
  }
}

}  // namespace

float openness(const Link& l) {
  if (l.visibility == Visibility::Clear) return 1.0f;
  const auto n = static_cast<float>(l.samples);
  // Many links are blocked for good: where none of 4, 8, 16 rays passed, 0.10, 0.037, 0.012 of all others do, in a
  // cabin of wooden walls and furniture.
  if (n > 0 && isBlack(l.V)) return 4.9f / (n * (n + 8.7f));
  return (maxChannel(l.V) * n + 0.5f) / (n + 1.0f);
}

bool samplesMeet(const Elements& elements, const Scene& scene, const Link& link, const SpaceChange& all,
                 const SpaceChange& before) {
  std::optional<DirectionWindow> window;
  if (elements.isDistant(link.sender)) {
    const ElementGeometry& r = elements.shape(link.receiver);
    Vec3 axis;
    if (const auto angle = all.seenFrom(r.center, r.radius, axis))
      window.emplace(elements, scene, link.sender, axis, *angle);
  }
  const std::uint64_t key = combineKeys(elements.key[link.receiver.index()], elements.key[link.sender.index()]);
  for (int i = 0; i < link.samples; ++i) {
    const auto u = stratified4(key, i);
    if (window && !window->holds(u[2], u[3])) continue;
    const SpaceChange& space = link.sampleMask >> i & 1u ? all : before;
    if (!mayMeet(elements, scene, link.receiver, link.sender, u, space)) continue;
    const Sample s = sampleOf(elements, scene, link.receiver, link.sender, u);
    if (s.weight > 0 && space.meets(s.ray)) return true;
  }
  return false;
}

namespace {

using Samples = std::vector<Sample>;

Samples samplesOf(const Elements& elements, const Scene& scene, ElementId receiver, ElementId sender, int count) {
  const std::uint64_t key = combineKeys(elements.key[receiver.index()], elements.key[sender.index()]);
  Samples samples;
  samples.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) samples.push_back(sampleOf(elements, scene, receiver, sender, stratified4(key, i)));
  return samples;
}

/// Of what passes(i, ray) says of each ray.
template <class Passes>
VisibilityEstimate estimate(const Samples& samples, bool clusterReceiver, const Passes& passes) {
  VisibilityEstimate result;
  RgbSum passed(0.0);
  double weights = 0, squares = 0, clearWeight = 0;
  std::array<double, 4> quadrantClear{}, quadrantWeight{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const auto& [ray, weight, quadrant] = samples[i];
    if (!(weight > 0)) continue;
    const Rgb through = passes(i, ray);
    const double seen = maxChannel(through) > 0 ? weight : 0.0;
    if (seen > 0) result.mask |= 1u << i;
    passed += weight * RgbSum(through);
    weights += weight;
    squares += weight * weight;
    // Where on the receiver the sample lies tells how visibility varies over it.
    clearWeight += seen;
    quadrantClear[quadrant] += seen;
    quadrantWeight[quadrant] += weight;
  }
  result.samples = static_cast<std::uint8_t>(samples.size());
  if (weights <= 0) {
    // No sampled pair faced each other: nothing is known.
    result.V = Rgb(1.0f);
    result.spread = 1.0f;
    return result;
  }
  result.V = Rgb(passed / weights);
  const double clear = clearWeight / weights;
  const double effective = weights * weights / squares;
  if (clear > 0 && clear < 1) {
    // The surfaces of a cluster are lit or not one by one: the mean over them speaks for none.
    double spread = std::sqrt(clear * (1 - clear) / (clusterReceiver ? 1.0 : effective));
    for (std::size_t q = 0; q < 4; ++q)
      if (quadrantWeight[q] > 0) spread = std::max(spread, std::abs(quadrantClear[q] / quadrantWeight[q] - clear));
    result.spread = static_cast<float>(spread);
  } else {
    // None of the rays disagrees: what they may have missed.
    result.spread = static_cast<float>(0.5 / (effective + 1));
  }
  return result;
}

}  // namespace

VisibilityEstimate sampleVisibility(const Elements& elements, const Scene& scene, const RayTracer& tracer,
                                    ElementId receiver, ElementId sender, int samples) {
  return estimate(samplesOf(elements, scene, receiver, sender, samples), elements.isCluster(receiver),
                  [&](std::size_t, const Ray& ray) { return tracer.transmittance(ray); });
}

VisibilityEstimate resampleVisibility(const Elements& elements, const Scene& scene, const RayTracer& tracer,
                                      const Link& link, const SpaceChange& space, int& rays) {
  const Samples samples = samplesOf(elements, scene, link.receiver, link.sender, link.samples);
  const bool clusterReceiver = elements.isCluster(link.receiver);
  const auto passed = [&](std::size_t i) { return Rgb(link.sampleMask >> i & 1u ? 1.0f : 0.0f); };
  const auto known = estimate(samples, clusterReceiver, [&](std::size_t i, const Ray&) { return passed(i); });
  const bool tinted = known.V != link.V;  // by glass: then the mask does not say what passed
  return estimate(samples, clusterReceiver, [&](std::size_t i, const Ray& ray) {
    if (!tinted && !space.meets(ray)) return passed(i);
    ++rays;
    return tracer.transmittance(ray);
  });
}

}  // namespace deltalux
