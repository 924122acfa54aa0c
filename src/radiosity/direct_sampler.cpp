#include "radiosity/direct_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "hierarchy/patch.hpp"
#include "paper/kernel.hpp"
#include "paper/sender_sampling.hpp"

namespace deltalux::radiosity {

namespace {

constexpr int kMostRays = 128;        // for one light
constexpr int kFewestCurved = 8;      // rays of a curved light: they measure K too
constexpr double kDoubt = 2;          // times the variance of lights together: so much chance alone shows, too
constexpr float kUnseenShare = 0.5f;  // most rays of one light that the links never saw, against all that they saw

}  // namespace

DirectSampler::DirectSampler(const Scene& scene, const hierarchy::Elements& elements, const hierarchy::Links& links,
                             const tracing::RayTracer& tracer)
    : scene_(scene),
      elements_(elements),
      links_(links),
      tracer_(tracer),
      exposure_(scene, elements, tracer),
      senders_(elements, links, scene, creditedStrength),
      lights_(scene, std::vector<Rgb>(scene.lights.size(), Rgb(1.0f))),
      places_(elements) {}

bool DirectSampler::curved(hierarchy::ElementId sender) const {
  return elements_.isPatch(sender) && !elements_.at(sender).flat;
}

std::uint64_t DirectSampler::rayKey(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
  return combineKeys(combineKeys(elements_.key[leaf.index()], 5), elements_.key[sender.index()]);
}

void DirectSampler::setKernel(hierarchy::ElementId leaf, Term& t) const {
  const hierarchy::ElementNodes& n = elements_.nodes[leaf.index()];
  for (std::size_t q = 0; q < 4; ++q) {
    if (n.weight[q] <= 0) continue;
    t.at[q] = static_cast<float>(paper::kernelAtPoint(elements_, scene_, n.position[q], n.normal[q], t.sender));
    t.K += n.weight[q] * t.at[q];
  }
}

DirectSampler::Term DirectSampler::term(hierarchy::ElementId leaf, const PossibleSender& s) const {
  Term t;
  t.link = s.link, t.sender = s.sender;
  t.clear = s.rays == 0 && s.open >= 1.0f;
  t.seen = s.open > 0;
  t.curved = curved(s.sender);
  t.open = t.clear ? 1.0f : (s.open * s.rays + 0.5f) / (s.rays + 1.0f);
  setKernel(leaf, t);
  t.weight = std::max(t.K * creditedStrength(elements_, s.sender), t.curved ? s.potential : 0.0f) * std::sqrt(t.open);
  return t;
}

/// What no ray of the links saw gets no more rays than what was seen.
std::vector<DirectSampler::Term> DirectSampler::terms(hierarchy::ElementId leaf,
                                                      const std::vector<PossibleSender>& senders) const {
  std::vector<Term> out;
  float seen = 0;
  for (const PossibleSender& s : senders) {
    const Term t = term(leaf, s);
    if (!(t.weight > 0)) continue;
    out.push_back(t);
    if (t.seen && !t.clear) seen += t.weight;
  }
  if (seen > 0)
    for (Term& t : out)
      if (!t.seen) t.weight = std::min(t.weight, kUnseenShare * seen);
  return out;
}

DirectRow DirectSampler::at(hierarchy::ElementId leaf, int rays) const {
  const std::vector<Term> all = terms(leaf, senders_.at(leaf));
  float total = 0;
  for (const Term& t : all) total += t.known() ? 0.0f : t.weight;
  Sampled sampled;
  deal(leaf, all, total / static_cast<float>(rays), sampled);
  DirectRow row;
  row.exposed = exposure_.of(leaf);
  row.mean = mean(leaf, sampled) / row.exposed;
  row.variation = variation(leaf, sampled) / row.exposed;
  const auto& weight = elements_.nodes[leaf.index()].weight;
  for (std::uint8_t q = 0; q < 4; ++q) {
    if (weight[q] <= 0) continue;  // nothing of the leaf
    if (!(weight[row.darkest] > 0) || sampled.E[q] < sampled.E[row.darkest]) row.darkest = q;
    if (!(weight[row.brightest] > 0) || sampled.E[q] > sampled.E[row.brightest]) row.brightest = q;
  }
  row.row = std::move(sampled.row), row.rays = sampled.rays;
  return row;
}

void DirectSampler::deal(hierarchy::ElementId leaf, const std::vector<Term>& terms, float step,
                         Sampled& sampled) const {
  sampled.row.weightPerRay = step;
  std::vector<Term> few;
  for (const Term& t : terms) {
    if (t.known()) {
      sampled.row.terms.push_back({t.link, t.sender, 1.0f, 0, 1, true});
      sampled.row.transfers.push_back({t.sender, Rgb(t.K)});
      remember(t.sender, {}, sampled.row);
      const double B = gray(elements_.radiometry[t.sender.index()].B);
      for (std::size_t q = 0; q < 4; ++q) sampled.E[q] += B * t.at[q];
      continue;
    }
    const float share = t.weight / step;
    if (share < 1.0f) {
      few.push_back(t);
      continue;
    }
    const int n = std::clamp(static_cast<int>(std::ceil(share)), t.curved ? kFewestCurved : 1, kMostRays);
    sample(leaf, t, n, 1.0f, sampled);
  }
  if (!few.empty()) dealFew(leaf, few, step, sampled);
  addPool(sampled);
}

void DirectSampler::dealFew(hierarchy::ElementId leaf, const std::vector<Term>& few, float step,
                            Sampled& sampled) const {
  const Roundings roundings(elements_, leaf);
  double weight = 0;
  std::uint64_t key = 0;
  std::vector<RayShare> shares;
  for (const Term& t : few) {
    const std::uint64_t own = elements_.key[t.sender.index()];
    shares.push_back({placeOf(t.sender), own, static_cast<std::uint32_t>(shares.size()), t.weight});
    weight += t.weight, key = combineKeys(key, own);
  }
  const double expected = weight / step;
  const int rays = static_cast<int>(expected + (expected < 1 ? roundings.of(key) : 0.5));
  const double perRay = weight / (expected < 1 ? expected : rays);
  dealOut(shares, rays, roundings, [&](std::uint32_t i, int own) {
    const Term& t = few[i];
    sample(leaf, t, own, static_cast<float>(own * perRay / t.weight), sampled);
  });
}

/// Distant lights by their direction.
std::uint64_t DirectSampler::placeOf(hierarchy::ElementId sender) const {
  const Vec3f& at = elements_.shape(sender).center;
  if (!elements_.isDistant(sender)) return places_.code(at);
  return places_.code(Vec3f(elements_.sceneBox.center()) +
                      0.5f * static_cast<float>(elements_.sceneBox.diagonal()) * at);
}

void DirectSampler::addPool(Sampled& out) const {
  const auto sum = [](const std::array<double, 4>& a) { return a[0] + a[1] + a[2] + a[3]; };
  const Pool& pool = out.pool;
  const double all = sum(pool.all), square = sum(pool.square);
  if (!(all > 0)) return;
  // As of so many rays of one weight.
  const double p = std::clamp(sum(pool.seen) / all, 0.0, 1.0), n = all * all / square;
  const double middle = std::clamp((p * n + 0.5) / (n + 1), 0.0, 1.0);
  for (std::size_t q = 0; q < 4; ++q) {
    const double own = pool.all[q] > 0 ? pool.all[q] * pool.all[q] / pool.square[q] : 0.0;
    out.E[q] += pool.whole[q] * (own > 0 ? pool.seen[q] / pool.all[q] : p);
    out.chance[q] += kDoubt * pool.whole[q] * pool.whole[q] * middle * (1 - middle) / (own > 0 ? own : n);
  }
  out.pool = {};
}

double DirectSampler::mean(hierarchy::ElementId leaf, const Sampled& sampled) const {
  const hierarchy::ElementNodes& n = elements_.nodes[leaf.index()];
  double mean = 0;
  for (std::size_t q = 0; q < 4; ++q) mean += n.weight[q] * sampled.E[q];
  return mean;
}

double DirectSampler::variation(hierarchy::ElementId leaf, const Sampled& sampled) const {
  const hierarchy::ElementNodes& n = elements_.nodes[leaf.index()];
  const double middle = mean(leaf, sampled);
  double chance = 0, between = 0;
  for (std::size_t q = 0; q < 4; ++q) {
    if (n.weight[q] <= 0) continue;
    between += n.weight[q] * (sampled.E[q] - middle) * (sampled.E[q] - middle);
    chance += n.weight[q] * sampled.chance[q];
  }
  return std::sqrt(std::max(0.0, between - chance));
}

bool DirectSampler::sampledByAngle(hierarchy::ElementId sender) const {
  const hierarchy::ElementTopology& t = elements_.at(sender);
  return t.kind == hierarchy::ElementKind::Patch && !t.flat && t.depth == 0;
}

/// Of an emitting surface whose light is as it was read.
Rgb DirectSampler::wholeB(hierarchy::ElementId sender) const {
  const auto& emission = scene_.materialOf(elements_.domain[sender.index()].primitive).emission;
  return emission ? float(kPi) * emission->radiance : Rgb(0.0f);
}

DirectSampler::Shot DirectSampler::shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, std::uint64_t key,
                                         int i) const {
  const auto u = paper::stratified4(key, i);
  const hierarchy::PatchPoint x = hierarchy::samplePatch(elements_, scene_, leaf, u[2], u[3]);
  Shot shot;
  shot.quadrant = (u[2] < 0.5 ? 0u : 1u) + (u[3] < 0.5 ? 0u : 2u);
  if (sampledByAngle(sender)) {
    const auto s = lights_.sample(elements_.light[sender.index()], Vec3(x.position), {u[0], u[1]});
    const double cosine = s ? glm::dot(s->direction, Vec3(x.normal)) : 0.0;
    if (!(cosine > 0) || !(s->pdf > 0)) return shot;
    shot.radiance = static_cast<float>(cosine / s->pdf) * s->radiance;
    shot.ray = tracing::segment(x.position, x.normal, x.position + Vec3f(s->distance * s->direction), Vec3f(s->normal));
    shot.weight = 1;
  } else if (elements_.isDistant(sender)) {
    const Vec3f w = hierarchy::directionOf(elements_, scene_, sender, u[0], u[1]);
    shot.weight = paper::pointKernel(elements_, scene_, x.position, x.normal, sender, w, Vec3f(0.0f));
    shot.ray.origin = tracing::offsetOrigin(x.position, x.normal, w);
    shot.ray.direction = w;
  } else {
    const hierarchy::PatchPoint y = paper::samplePoint(elements_, scene_, sender, u[0], u[1]);
    shot.weight = paper::pointKernel(elements_, scene_, x.position, x.normal, sender, y.position, y.normal);
    shot.ray = tracing::segment(x.position, x.normal, y.position, y.normal);
  }
  return shot;
}

/// Where a ray ends, or leaves the scene's box.
Vec3f DirectSampler::endOf(const tracing::Ray& ray) const {
  const Vec3f lower(elements_.sceneBox.lower), upper(elements_.sceneBox.upper);
  float far = ray.tFar;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0) continue;
    const float exit = ((ray.direction[axis] > 0 ? upper : lower)[axis] - ray.origin[axis]) / ray.direction[axis];
    far = std::min(far, std::max(exit, 0.0f));
  }
  return ray.origin + far * ray.direction;
}

/// Notes where the rays of a row's term go.
void DirectSampler::remember(hierarchy::ElementId sender, const Passage& p, TransferRow& row) const {
  row.reach.add(p.reach);
  if (elements_.isPatch(sender)) row.reach.objects.add(scene_, elements_.domain[sender.index()].primitive);
}

DirectSampler::Passage DirectSampler::pass(hierarchy::ElementId leaf, const Term& t, int rays, std::uint64_t key,
                                           std::uint64_t& traced) const {
  const bool byAngle = sampledByAngle(t.sender);
  Passage p;
  RgbSum passed(0.0);
  for (int i = 0; i < rays + (byAngle ? 0 : kFacingTries) && p.used < rays; ++i) {
    const Shot shot = shoot(leaf, t.sender, key, i);
    p.used += byAngle || shot.weight > 0;
    if (!(shot.weight > 0)) continue;
    tracing::Passing through;
    if (!t.clear) through = tracer_.passing(shot.ray), ++traced;
    const Rgb V = byAngle ? through.share * shot.radiance : through.share;
    passed += shot.weight * RgbSum(V);
    if (tracing::endsAtOne(scene_, through))
      p.reach.objects.add(scene_, through.blocker);
    else
      p.reach.add(elements_.shape(leaf), endOf(shot.ray));
    p.weights += shot.weight;
    p.seen[shot.quadrant] += shot.weight * gray(V), p.all[shot.quadrant] += shot.weight;
    ++p.count[shot.quadrant];
  }
  if (!(p.weights > 0)) return p;
  p.T = byAngle ? Rgb(passed / double(p.used)) : Rgb(double(t.K) * passed / p.weights);
  if (!byAngle) return p;
  const Rgb B = wholeB(t.sender);
  for (int c = 0; c < 3; ++c) p.T[c] = B[c] > 0 ? p.T[c] / B[c] : 0.0f;
  return p;
}

void DirectSampler::sample(hierarchy::ElementId leaf, const Term& t, int rays, float gain, Sampled& out) const {
  const Rgb B = elements_.radiometry[t.sender.index()].B;
  const Passage s = pass(leaf, t, rays, rayKey(leaf, t.sender), out.rays);
  out.row.terms.push_back({t.link, t.sender, gain, static_cast<std::uint16_t>(rays), 0, t.clear});
  remember(t.sender, s, out.row);
  if (!(s.weights > 0)) return;
  const bool byAngle = sampledByAngle(t.sender);
  const bool few = std::any_of(s.count.begin(), s.count.end(), [](int n) { return n == 0; });
  const double n = s.used;
  const double p = std::clamp((s.seen[0] + s.seen[1] + s.seen[2] + s.seen[3]) / s.weights, 0.0, 1.0);
  const double shown = byAngle ? gray(B) / std::max<double>(gray(wholeB(t.sender)), 1e-30) : 0.0;
  for (std::size_t q = 0; q < 4; ++q) {
    if (byAngle) {
      out.E[q] += gain * (s.count[q] > 0 ? shown * s.seen[q] / s.count[q] : gray(s.T * B));
      continue;
    }
    const double E = gain * t.at[q] * gray(B);
    if (few) {
      const double worth = gain * double(t.K) * gray(B) / s.weights;
      out.pool.whole[q] += E;
      out.pool.all[q] += worth * s.all[q], out.pool.seen[q] += worth * s.seen[q];
      out.pool.square[q] += s.count[q] > 0 ? worth * worth * s.all[q] * s.all[q] / s.count[q] : 0.0;
      continue;
    }
    const double V = s.seen[q] / s.all[q];
    const double q1 = std::clamp((p * n + 0.5) / (n + 1), 0.0, 1.0);
    out.E[q] += E * V;
    out.chance[q] += E * E * q1 * (1 - q1) / s.count[q];
  }
  if (isBlack(s.T)) return;
  out.row.terms.back().count = 1;
  out.row.transfers.push_back({t.sender, gain * s.T});
}

}  // namespace deltalux::radiosity
