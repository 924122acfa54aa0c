#include "radiosity/visibility.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/kernel.hpp"

namespace deltalux {

namespace {

double fraction(double x) { return x - std::floor(x); }

/// Sample i of the plastic sequence (Roberts' R4), shifted by the key: four stratified numbers for any prefix.
std::array<double, 4> stratified(std::uint64_t key, int i) {
  static constexpr std::array<double, 4> step = {0.8566748838545029, 0.7338918566271260, 0.6287067210378087,
                                                 0.5385972572236101};
  std::array<double, 4> u{};
  for (std::size_t k = 0; k < 4; ++k) u[k] = fraction(toUnit(mix64(key + k)) + (i + 1) * step[k]);
  return u;
}

/// A surface point of any element; clusters pick children by area.
PatchPoint pointOf(const Elements& elements, const Scene& scene, ElementId e, double a, double b) {
  while (elements.isCluster(e)) {
    double rest = a * elements.shape(e).area;
    ElementId next;
    double nextArea = 0;
    for (std::size_t i = 0; i < elements.at(e).childCount; ++i) {
      const ElementId c = elements.child(e, i);
      const double part = elements.at(c).blocker ? 0.0 : double(elements.shape(c).area);
      if (part <= 0) continue;
      next = c, nextArea = part;
      if (rest < part) break;
      rest -= part;
    }
    if (!next.valid()) break;
    a = std::clamp(rest / nextArea, 0.0, 0x1.fffffep-1);
    e = next;
  }
  if (elements.isPatch(e)) return samplePatch(elements, scene, e, a, b);
  return {elements.shape(e).center, Vec3f(0.0f)};
}

}  // namespace

VisibilityEstimate sampleVisibility(const Elements& elements, const Scene& scene, const RayTracer& tracer,
                                    ElementId receiver, ElementId sender, int samples, SampleSet set) {
  VisibilityEstimate result;
  const std::uint64_t key = combineKeys(combineKeys(elements.key[receiver.index()], elements.key[sender.index()]),
                                        static_cast<std::uint64_t>(set));
  RgbSum passed(0.0);
  double weights = 0, squares = 0, clearWeight = 0;
  std::array<double, 4> quadrantClear{}, quadrantWeight{};
  for (int i = 0; i < samples; ++i) {
    const auto u = stratified(key, i);
    const PatchPoint x = pointOf(elements, scene, receiver, u[0], u[1]);
    Ray ray;
    double weight = 0;
    if (elements.isDistant(sender)) {
      const Vec3f w = directionOf(elements, scene, sender, u[2], u[3]);
      weight = pointKernel(elements, scene, x.position, x.normal, sender, w, Vec3f(0.0f));
      ray.origin = offsetOrigin(x.position, x.normal, w);
      ray.direction = w;
    } else {
      const PatchPoint y = pointOf(elements, scene, sender, u[2], u[3]);
      weight = elements.isPoint(sender) || elements.isPatch(sender)
                   ? pointKernel(elements, scene, x.position, x.normal, sender, y.position, y.normal)
                   : std::max(0.0f, glm::dot(x.normal, y.position - x.position)) *
                         std::max(0.0f, glm::dot(y.normal, x.position - y.position));
      if (elements.isCluster(sender)) {
        const Vec3f between = y.position - x.position;
        const double squared = glm::dot(between, between);
        weight = squared > 0 ? weight / (squared * squared) : 0.0;
      }
      if (weight > 0) ray = segment(x.position, x.normal, y.position, y.normal);
    }
    if (!(weight > 0)) continue;
    const Rgb through = tracer.transmittance(ray);
    const double seen = maxChannel(through) > 0 ? weight : 0.0;
    if (seen > 0) result.mask |= 1u << i;
    passed += weight * RgbSum(through);
    weights += weight;
    squares += weight * weight;
    // Where on the receiver the sample lies tells how visibility varies over it.
    const std::size_t quadrant = (u[0] < 0.5 ? 0u : 1u) + (u[1] < 0.5 ? 0u : 2u);
    clearWeight += seen;
    quadrantClear[quadrant] += seen;
    quadrantWeight[quadrant] += weight;
  }
  result.samples = static_cast<std::uint8_t>(samples);
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
    double spread = std::sqrt(clear * (1 - clear) / (elements.isCluster(receiver) ? 1.0 : effective));
    for (std::size_t q = 0; q < 4; ++q)
      if (quadrantWeight[q] > 0) spread = std::max(spread, std::abs(quadrantClear[q] / quadrantWeight[q] - clear));
    result.spread = static_cast<float>(spread);
  } else {
    // None of the rays disagrees: what they may have missed.
    result.spread = static_cast<float>(0.5 / (effective + 1));
  }
  return result;
}

}  // namespace deltalux
