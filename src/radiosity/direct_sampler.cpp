#include "radiosity/direct_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/patch.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

constexpr int kFewestCurved = 8;      // rays of a curved light: they measure K too
constexpr float kUnseenShare = 0.5f;  // most rays of one light that the links never saw, against all that they saw

}  // namespace

struct DirectSampler::Term {
  ElementId sender;
  bool curved = false, clear = false, seen = false;
  float K = 0;
  std::array<float, 4> at{};  // K at the leaf's nodes
  float open = 0, weight = 0;
};

/// Irradiance by quadrant, and the variance that chance gives it.
struct DirectSampler::Quadrants {
  std::array<double, 4> E{}, chance{};
};

DirectSampler::DirectSampler(const Scene& scene, const Elements& elements, const Links& links, const RayTracer& tracer)
    : scene_(scene),
      elements_(elements),
      tracer_(tracer),
      exposure_(scene, elements, tracer),
      senders_(elements, links, scene),
      lights_(scene) {}

DirectSampler::Term DirectSampler::term(ElementId leaf, const PossibleSender& s) const {
  Term t;
  t.sender = s.sender;
  t.clear = s.rays == 0 && s.open >= 1.0f;
  t.seen = s.open > 0;
  t.curved = elements_.isPatch(s.sender) && !elements_.at(s.sender).flat;
  t.open = t.clear ? 1.0f : (s.open * s.rays + 0.5f) / (s.rays + 1.0f);
  const ElementNodes& n = elements_.nodes[leaf.index()];
  for (std::size_t q = 0; q < 4; ++q) {
    if (n.weight[q] <= 0) continue;
    t.at[q] = static_cast<float>(kernelAtPoint(elements_, scene_, n.position[q], n.normal[q], s.sender));
    t.K += n.weight[q] * t.at[q];
  }
  const float B = gray(elements_.radiometry[s.sender.index()].B);
  t.weight = std::max(t.K * B, t.curved ? s.potential : 0.0f) * std::sqrt(t.open);
  return t;
}

DirectRow DirectSampler::at(ElementId leaf, int rays) const {
  DirectRow row;
  std::vector<Term> terms;
  float seen = 0, total = 0;
  for (const PossibleSender& s : senders_.at(leaf)) {
    const Term t = term(leaf, s);
    if (!(t.weight > 0)) continue;
    terms.push_back(t);
    if (t.seen && !t.clear) seen += t.weight;
  }
  for (Term& t : terms) {
    if (!t.seen && seen > 0) t.weight = std::min(t.weight, kUnseenShare * seen);
    total += t.clear && !t.curved ? 0.0f : t.weight;
  }
  Quadrants quadrants;
  const std::uint64_t place = combineKeys(elements_.key[leaf.index()], 5);
  for (const Term& t : terms) {
    const std::uint64_t key = combineKeys(place, elements_.key[t.sender.index()]);
    if (t.clear && !t.curved) {
      row.lights.push_back({t.sender, Rgb(t.K)});
      const double B = gray(elements_.radiometry[t.sender.index()].B);
      for (std::size_t q = 0; q < 4; ++q) quadrants.E[q] += B * t.at[q];
      continue;
    }
    const float share = static_cast<float>(rays) * t.weight / total;
    if (share < 1.0f) {
      if (toUnit(mix64(combineKeys(key, 1))) < share) sample(leaf, t, 1, 1.0f / share, key, row, quadrants);
      continue;
    }
    const int n = std::max(static_cast<int>(std::ceil(share)), t.curved ? kFewestCurved : 1);
    sample(leaf, t, n, 1.0f, key, row, quadrants);
  }
  const ElementNodes& n = elements_.nodes[leaf.index()];
  double chance = 0, between = 0;
  for (std::size_t q = 0; q < 4; ++q) row.mean += n.weight[q] * quadrants.E[q];
  for (std::size_t q = 0; q < 4; ++q) {
    if (n.weight[q] <= 0) continue;
    between += n.weight[q] * (quadrants.E[q] - row.mean) * (quadrants.E[q] - row.mean);
    chance += n.weight[q] * quadrants.chance[q];
  }
  row.exposed = exposure_.of(leaf);
  for (LeafTransfer& t : row.lights) t.T /= row.exposed;
  row.mean /= row.exposed;
  row.variation = std::sqrt(std::max(0.0, between - chance)) / row.exposed;
  return row;
}

void DirectSampler::sample(ElementId leaf, const Term& t, int rays, float gain, std::uint64_t key, DirectRow& row,
                           Quadrants& quadrants) const {
  const Rgb B = elements_.radiometry[t.sender.index()].B;
  RgbSum passed(0.0);
  double weights = 0;
  std::array<double, 4> seen{}, all{};
  std::array<int, 4> count{};
  const int tries = t.curved ? rays : rays + 8;
  int used = 0;
  for (int i = 0; i < tries && used < rays; ++i) {
    const auto u = stratified4(key, i);
    const PatchPoint x = samplePatch(elements_, scene_, leaf, u[2], u[3]);
    double weight = 0;
    Ray ray;
    Rgb radiance(0.0f);  // of a curved light's sample: cos L / p
    if (t.curved && elements_.at(t.sender).depth == 0) {
      ++used;
      const auto s = lights_.sample(elements_.light[t.sender.index()], Vec3(x.position), {u[0], u[1]});
      const double cosine = s ? glm::dot(s->direction, Vec3(x.normal)) : 0.0;
      if (!(cosine > 0) || !(s->pdf > 0)) continue;
      radiance = static_cast<float>(cosine / s->pdf) * s->radiance;
      ray = segment(x.position, x.normal, x.position + Vec3f(s->distance * s->direction), Vec3f(s->normal));
      weight = 1;
    } else if (elements_.isDistant(t.sender)) {
      const Vec3f w = directionOf(elements_, scene_, t.sender, u[0], u[1]);
      weight = pointKernel(elements_, scene_, x.position, x.normal, t.sender, w, Vec3f(0.0f));
      ray.origin = offsetOrigin(x.position, x.normal, w);
      ray.direction = w;
    } else {
      const PatchPoint y = samplePoint(elements_, scene_, t.sender, u[0], u[1]);
      weight = pointKernel(elements_, scene_, x.position, x.normal, t.sender, y.position, y.normal);
      ray = segment(x.position, x.normal, y.position, y.normal);
    }
    if (!(weight > 0)) continue;
    if (!t.curved || elements_.at(t.sender).depth > 0) ++used;
    const Rgb V = t.clear ? Rgb(1.0f) : tracer_.transmittance(ray);
    row.rays += !t.clear;
    const std::size_t q = (u[2] < 0.5 ? 0u : 1u) + (u[3] < 0.5 ? 0u : 2u);
    const bool measured = !isBlack(radiance);
    passed += weight * (measured ? RgbSum(V * radiance) : RgbSum(V));
    weights += weight;
    seen[q] += weight * gray(measured ? V * radiance : V), all[q] += weight;
    ++count[q];
  }
  if (!(weights > 0)) return;
  const bool measured = t.curved && elements_.at(t.sender).depth == 0;
  const double n = used;
  Rgb T = measured ? Rgb(passed / n) : Rgb(double(t.K) * passed / weights);
  const double p = std::clamp((seen[0] + seen[1] + seen[2] + seen[3]) / weights, 0.0, 1.0);
  for (std::size_t q = 0; q < 4; ++q) {
    if (measured) {
      quadrants.E[q] += gain * (count[q] > 0 ? seen[q] / count[q] : gray(T));
      continue;
    }
    const double E = gain * t.at[q] * gray(B);
    const double V = all[q] > 0 ? seen[q] / all[q] : p, known = count[q] > 0 ? count[q] : n;
    const double q1 = std::clamp((p * n + 0.5) / (n + 1), 0.0, 1.0);
    quadrants.E[q] += E * V;
    quadrants.chance[q] += E * E * q1 * (1 - q1) / known;
  }
  if (measured)
    for (int c = 0; c < 3; ++c) T[c] = B[c] > 0 ? T[c] / B[c] : 0.0f;
  if (!isBlack(T)) row.lights.push_back({t.sender, gain * T});
}

}  // namespace deltalux
