#include "radiosity/direct_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/patch.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

constexpr int kMostRays = 128;        // for one light
constexpr int kFacingTries = 8;       // more points of a light when some face away
constexpr int kFewestCurved = 8;      // rays of a curved light: they measure K too
constexpr float kUnseenShare = 0.5f;  // most rays of one light that the links never saw, against all that they saw

}  // namespace

struct DirectSampler::Term {
  LinkId link;
  ElementId sender;
  bool curved = false, clear = false, seen = false;
  float K = 0;
  std::array<float, 4> at{};  // K at the leaf's nodes
  float open = 0, weight = 0;
};

/// What the shadow rays of a light find.
struct DirectSampler::Passage {
  Rgb T{0.0f};
  double weights = 0;
  std::array<double, 4> seen{}, all{};  // by quadrant of the leaf
  std::array<int, 4> count{};
  int used = 0;
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

bool DirectSampler::curved(ElementId sender) const { return elements_.isPatch(sender) && !elements_.at(sender).flat; }

std::uint64_t DirectSampler::rayKey(ElementId leaf, ElementId sender) const {
  return combineKeys(combineKeys(elements_.key[leaf.index()], 5), elements_.key[sender.index()]);
}

void DirectSampler::setKernel(ElementId leaf, Term& t) const {
  const ElementNodes& n = elements_.nodes[leaf.index()];
  for (std::size_t q = 0; q < 4; ++q) {
    if (n.weight[q] <= 0) continue;
    t.at[q] = static_cast<float>(kernelAtPoint(elements_, scene_, n.position[q], n.normal[q], t.sender));
    t.K += n.weight[q] * t.at[q];
  }
}

DirectSampler::Term DirectSampler::term(ElementId leaf, const PossibleSender& s) const {
  Term t;
  t.link = s.link, t.sender = s.sender;
  t.clear = s.rays == 0 && s.open >= 1.0f;
  t.seen = s.open > 0;
  t.curved = curved(s.sender);
  t.open = t.clear ? 1.0f : (s.open * s.rays + 0.5f) / (s.rays + 1.0f);
  setKernel(leaf, t);
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
  for (const Term& t : terms) {
    const std::uint64_t key = rayKey(leaf, t.sender);
    if (t.clear && !t.curved) {
      row.row.terms.push_back({t.link, t.sender, 1.0f, 0, 1, true});
      row.row.transfers.push_back({t.sender, Rgb(t.K)});
      const double B = gray(elements_.radiometry[t.sender.index()].B);
      for (std::size_t q = 0; q < 4; ++q) quadrants.E[q] += B * t.at[q];
      continue;
    }
    const float share = static_cast<float>(rays) * t.weight / total;
    if (share < 1.0f) {
      if (toUnit(mix64(combineKeys(key, 1))) < share) sample(leaf, t, 1, 1.0f / share, key, row, quadrants);
      continue;
    }
    const int n = std::clamp(static_cast<int>(std::ceil(share)), t.curved ? kFewestCurved : 1, kMostRays);
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
  row.mean /= row.exposed;
  row.variation = std::sqrt(std::max(0.0, between - chance)) / row.exposed;
  return row;
}

/// One shadow ray. A light that is sampled by solid angle brings its radiance times cosine over density.
struct DirectSampler::Shot {
  Ray ray;
  double weight = 0;  // not above 0: light and place do not face each other
  Rgb radiance{0.0f};
  std::size_t quadrant = 0;
};

bool DirectSampler::sampledByAngle(ElementId sender) const {
  const ElementTopology& t = elements_.at(sender);
  return t.kind == ElementKind::Patch && !t.flat && t.depth == 0;
}

DirectSampler::Shot DirectSampler::shoot(ElementId leaf, ElementId sender, std::uint64_t key, int i) const {
  const auto u = stratified4(key, i);
  const PatchPoint x = samplePatch(elements_, scene_, leaf, u[2], u[3]);
  Shot shot;
  shot.quadrant = (u[2] < 0.5 ? 0u : 1u) + (u[3] < 0.5 ? 0u : 2u);
  if (sampledByAngle(sender)) {
    const auto s = lights_.sample(elements_.light[sender.index()], Vec3(x.position), {u[0], u[1]});
    const double cosine = s ? glm::dot(s->direction, Vec3(x.normal)) : 0.0;
    if (!(cosine > 0) || !(s->pdf > 0)) return shot;
    shot.radiance = static_cast<float>(cosine / s->pdf) * s->radiance;
    shot.ray = segment(x.position, x.normal, x.position + Vec3f(s->distance * s->direction), Vec3f(s->normal));
    shot.weight = 1;
  } else if (elements_.isDistant(sender)) {
    const Vec3f w = directionOf(elements_, scene_, sender, u[0], u[1]);
    shot.weight = pointKernel(elements_, scene_, x.position, x.normal, sender, w, Vec3f(0.0f));
    shot.ray.origin = offsetOrigin(x.position, x.normal, w);
    shot.ray.direction = w;
  } else {
    const PatchPoint y = samplePoint(elements_, scene_, sender, u[0], u[1]);
    shot.weight = pointKernel(elements_, scene_, x.position, x.normal, sender, y.position, y.normal);
    shot.ray = segment(x.position, x.normal, y.position, y.normal);
  }
  return shot;
}

bool DirectSampler::meets(ElementId leaf, const RowTerm& t, const SpaceChange& space) const {
  const ElementGeometry &r = elements_.shape(leaf), &s = elements_.shape(t.sender);
  if (elements_.isDistant(t.sender) ? !space.meetsBeam(r.center, r.radius, s.center, s.radius)
                                    : !space.meets(r.center, r.radius, s.center, s.radius))
    return false;
  const std::uint64_t key = rayKey(leaf, t.sender);
  const bool byAngle = sampledByAngle(t.sender);
  int used = 0;
  for (int i = 0; i < t.index + (byAngle ? 0 : kFacingTries) && used < t.index; ++i) {
    const Shot shot = shoot(leaf, t.sender, key, i);
    if (shot.weight > 0 && space.meets(shot.ray)) return true;
    used += byAngle || shot.weight > 0;
  }
  return false;
}

DirectUpdate DirectSampler::update(ElementId leaf, const LinkChanges& links, const SpaceChange& space, TransferRow& row,
                                   std::uint64_t& traced) const {
  DirectUpdate update;
  std::vector<LeafTransfer> next;
  auto at = row.transfers.begin();
  for (RowTerm& t : row.terms) {
    const auto begin = at;
    at += t.count;
    const LinkChange change = changeOf(links, t.link);
    if (change == LinkChange::Changed || space.moved(t.sender)) return {true, false, 0.0};
    if (change == LinkChange::None || t.clear || !meets(leaf, t, space)) {
      if (update.any) next.insert(next.end(), begin, at);
      continue;
    }
    if (!update.any) next.assign(row.transfers.begin(), begin);
    update.any = true;
    Term same;
    same.sender = t.sender, same.curved = curved(t.sender);
    setKernel(leaf, same);
    const Passage p = pass(leaf, same, t.index, rayKey(leaf, t.sender), traced);
    const Rgb T = t.gain * p.T, before = t.count > 0 ? begin->T : Rgb(0.0f);
    update.change += std::abs(gray((T - before) * elements_.radiometry[t.sender.index()].B));
    t.count = !isBlack(T);
    if (t.count > 0) next.push_back({t.sender, T});
  }
  if (update.any) row.transfers = std::move(next);
  return update;
}

DirectSampler::Passage DirectSampler::pass(ElementId leaf, const Term& t, int rays, std::uint64_t key,
                                           std::uint64_t& traced) const {
  const bool byAngle = sampledByAngle(t.sender);
  Passage p;
  RgbSum passed(0.0);
  for (int i = 0; i < rays + (byAngle ? 0 : kFacingTries) && p.used < rays; ++i) {
    const Shot shot = shoot(leaf, t.sender, key, i);
    p.used += byAngle || shot.weight > 0;
    if (!(shot.weight > 0)) continue;
    Rgb V(1.0f);
    if (!t.clear) V = tracer_.transmittance(shot.ray), ++traced;
    if (byAngle) V *= shot.radiance;
    passed += shot.weight * RgbSum(V);
    p.weights += shot.weight;
    p.seen[shot.quadrant] += shot.weight * gray(V), p.all[shot.quadrant] += shot.weight;
    ++p.count[shot.quadrant];
  }
  if (!(p.weights > 0)) return p;
  p.T = byAngle ? Rgb(passed / double(p.used)) : Rgb(double(t.K) * passed / p.weights);
  if (!byAngle) return p;
  const Rgb B = elements_.radiometry[t.sender.index()].B;
  for (int c = 0; c < 3; ++c) p.T[c] = B[c] > 0 ? p.T[c] / B[c] : 0.0f;
  return p;
}

void DirectSampler::sample(ElementId leaf, const Term& t, int rays, float gain, std::uint64_t key, DirectRow& row,
                           Quadrants& quadrants) const {
  const Rgb B = elements_.radiometry[t.sender.index()].B;
  const Passage s = pass(leaf, t, rays, key, row.rays);
  row.row.terms.push_back({t.link, t.sender, gain, static_cast<std::uint8_t>(rays), 0, t.clear});
  if (!(s.weights > 0)) return;
  const bool byAngle = sampledByAngle(t.sender);
  const double n = s.used;
  const double p = std::clamp((s.seen[0] + s.seen[1] + s.seen[2] + s.seen[3]) / s.weights, 0.0, 1.0);
  for (std::size_t q = 0; q < 4; ++q) {
    if (byAngle) {
      quadrants.E[q] += gain * (s.count[q] > 0 ? s.seen[q] / s.count[q] : gray(s.T * B));
      continue;
    }
    const double E = gain * t.at[q] * gray(B);
    const double V = s.all[q] > 0 ? s.seen[q] / s.all[q] : p, known = s.count[q] > 0 ? s.count[q] : n;
    const double q1 = std::clamp((p * n + 0.5) / (n + 1), 0.0, 1.0);
    quadrants.E[q] += E * V;
    quadrants.chance[q] += E * E * q1 * (1 - q1) / known;
  }
  if (isBlack(s.T)) return;
  row.row.terms.back().count = 1;
  row.row.transfers.push_back({t.sender, gain * s.T});
}

}  // namespace deltalux
