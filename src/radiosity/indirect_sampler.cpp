#include "radiosity/indirect_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

constexpr float kNear = 8.0f;         // in radii of the leaf: nearer to a sender than this, K is taken at all its nodes
constexpr float kLeastKernel = 0.1f;  // relative to that of a sender that faces the place with a quarter of its area
constexpr float kFaint = 0.1f;   // of the light here: radiosity that senders are credited with, so that rows hold what
                                 // may light up later, and what is all but dark gets no few heavy samples
constexpr float kUneven = 2.0f;  // rays of clusters and curved senders, whose points differ most, against others
constexpr float kPartsShare = 2.0f;   // rays of a sender above which it is taken apart
constexpr float kWholeShare = 0.25f;  // the same for senders that need no ray: their radiosity counts as even
constexpr int kFacingTries = 16;      // more points of a sender when some face away

bool carries(const Elements& elements, const Link& l) {
  return l.state == LinkState::Active && l.visibility != Visibility::Blocked && !elements.at(l.sender).emitter;
}

/// Transfer that clusters and curved senders are credited with: their nodes may all face away where some part does not.
float leastKernel(const Elements& elements, const Vec3f& x, ElementId sender) {
  const ElementGeometry& g = elements.shape(sender);
  const Vec3f d = g.center - x;
  const float squared = std::max(glm::dot(d, d), g.radius * g.radius);
  return kLeastKernel * (elements.isCluster(sender) ? 1.0f : g.area / float(kPi)) / squared;
}

/// Chance that light passes, as the link's rays leave it: one that saw nothing may still be open. 1: it surely passes.
float openness(const Link& l) {
  if (l.visibility == Visibility::Clear) return 1.0f;
  const auto n = static_cast<float>(l.samples);
  return (maxChannel(l.V) * n + 0.5f) / (n + 1.0f);
}

}  // namespace

IndirectSampler::IndirectSampler(const Scene& scene, const Elements& elements, const Links& links,
                                 const RayTracer& tracer)
    : scene_(scene), elements_(elements), tracer_(tracer), exposure_(scene, elements, tracer), links_(links) {}

float IndirectSampler::strength(ElementId receiver, ElementId sender) const {
  const ElementLight& here = elements_.radiometry[receiver.index()];
  const float faint = kFaint * std::max(gray(here.indirect), here.tolerance);
  if (!elements_.isCluster(sender)) {
    const ElementLight& there = elements_.radiometry[sender.index()];
    return isBlack(there.rho + there.tau) ? 0.0f : gray(there.B) + faint;
  }
  const Vec3f w = elements_.shape(receiver).center - elements_.shape(sender).center;
  const DirectionalRgb& intensity = elements_.cluster(sender).intensity;
  const float mean = 0.28209479f * std::max(0.0f, gray(intensity.c[0]));
  const float facing = glm::length(w) > 0 ? std::max(gray(intensity.at(glm::normalize(w))), 0.25f * mean) : mean;
  return facing + faint * elements_.shape(sender).area / (4 * float(kPi));
}

template <class KernelOf>
IndirectSampler::Term IndirectSampler::term(ElementId leaf, ElementId sender, float open,
                                            const KernelOf& kernelOf) const {
  Term t{sender, 0.0f, open, 0.0f};
  const float B = strength(leaf, sender);
  if (!(B > 0)) return t;
  t.K = static_cast<float>(kernelOf(sender, open >= 1.0f));
  if (!exact(sender)) t.K = std::max(t.K, leastKernel(elements_, elements_.shape(leaf).center, sender));
  t.weight = t.K * B * std::sqrt(open) * (exact(sender) ? 1.0f : kUneven);
  return t;
}

template <class KernelOf>
std::vector<IndirectSampler::Term> IndirectSampler::terms(ElementId leaf, int rays, const KernelOf& kernelOf) const {
  std::vector<Term> whole;
  float total = 0;
  for (ElementId r = leaf; r.valid(); r = elements_.at(r).parent) {
    for (LinkId id = links_.first(r); id.valid(); id = links_[id].nextArriving) {
      const Link& l = links_[id];
      if (!carries(elements_, l)) continue;
      const Term t = term(leaf, l.sender, openness(l), kernelOf);
      if (!(t.weight > 0)) continue;
      whole.push_back(t);
      total += t.weight;
    }
  }
  // A sender that would get several rays is taken apart instead: its parts are nearer or farther, brighter or darker.
  const float ray = total / static_cast<float>(rays);
  std::vector<Term> parts;
  while (!whole.empty()) {
    const Term t = whole.back();
    whole.pop_back();
    if (t.weight <= (known(t) ? kWholeShare : kPartsShare) * ray || elements_.isLeaf(t.sender)) {
      parts.push_back(t);
      continue;
    }
    for (std::size_t i = elements_.at(t.sender).childCount; i-- > 0;) {
      const Term part = term(leaf, elements_.child(t.sender, i), t.open, kernelOf);
      if (part.weight > 0) whole.push_back(part);
    }
  }
  return parts;
}

bool IndirectSampler::exact(ElementId sender) const { return elements_.isPatch(sender) && elements_.at(sender).flat; }

/// What a part of a sender may bring, by its centre alone.
float IndirectSampler::guess(ElementId leaf, const PatchPoint& x, ElementId part) const {
  const float B = strength(leaf, part);
  if (!(B > 0)) return 0.0f;
  const ElementGeometry& g = elements_.shape(part);
  float K = 0;
  if (elements_.isCluster(part)) {
    K = static_cast<float>(kernelAtPoint(elements_, scene_, x.position, x.normal, part));
  } else {
    const Vec3f d = g.center - x.position;
    const float squared = glm::dot(d, d);
    K = static_cast<float>(pointKernel(elements_, scene_, x.position, x.normal, part, g.center, g.normal)) * g.area *
        squared / (squared + g.area / float(kPi));
  }
  return std::max(K, leastKernel(elements_, x.position, part)) * B * (exact(part) ? 1.0f : kUneven);
}

ElementId IndirectSampler::descend(ElementId sender, ElementId leaf, const PatchPoint& x, double& u,
                                   double& chance) const {
  std::vector<float> guesses;
  while (!elements_.isLeaf(sender)) {
    guesses.clear();
    double total = 0;
    for (std::size_t i = 0; i < elements_.at(sender).childCount; ++i)
      total += guesses.emplace_back(guess(leaf, x, elements_.child(sender, i)));
    if (!(total > 0)) return {};
    double rest = u * total;
    std::size_t picked = 0;
    while (picked + 1 < guesses.size() && (rest >= guesses[picked] || !(guesses[picked] > 0)))
      rest -= guesses[picked++];
    while (!(guesses[picked] > 0)) --picked;
    u = std::clamp(rest / guesses[picked], 0.0, 0x1.fffffep-1);
    chance *= guesses[picked] / total;
    sender = elements_.child(sender, picked);
  }
  return sender;
}

template <class KernelOf, class PointAt, class Visit>
std::size_t IndirectSampler::sample(ElementId leaf, const PatchPoint& center, int rays, const KernelOf& kernelOf,
                                    const PointAt& pointAt, const Visit& visit) const {
  const std::vector<Term> all = terms(leaf, rays, kernelOf);
  double total = 0, passed = 0;
  for (const Term& t : all) total += known(t) ? 0.0f : t.weight;
  const double step = total / rays;
  const std::uint64_t key = elements_.key[leaf.index()];
  double next = toUnit(mix64(key)) * step;
  std::size_t traced = 0;
  for (const Term& t : all) {
    if (known(t)) {
      visit(t.sender, Rgb(t.K));
      continue;
    }
    passed += t.weight;
    const std::uint64_t own = combineKeys(key, elements_.key[t.sender.index()]);
    for (int i = 0; next < passed; ++i, next += step) {
      auto u = stratified4(own, i);
      double chance = t.weight / step;
      const ElementId from = descend(t.sender, leaf, center, u[0], chance);
      if (!from.valid()) continue;
      const Term part = from == t.sender ? t : term(leaf, from, t.open, kernelOf);
      if (part.K > 0)
        traced += sampleLeaf(part, static_cast<float>(1.0 / chance), combineKeys(own, i), u, pointAt, visit);
    }
  }
  return traced;
}

template <class PointAt, class Visit>
std::size_t IndirectSampler::sampleLeaf(const Term& t, float gain, std::uint64_t key, std::array<double, 4> u,
                                        const PointAt& pointAt, const Visit& visit) const {
  const bool flat = exact(t.sender);
  for (int tries = 0; tries < (flat ? kFacingTries : 1); ++tries) {
    if (tries > 0) u = stratified4(key, tries);
    const SenderSample s = sampleLeafOf(elements_, scene_, pointAt(u[2], u[3]), t.sender, u[0], u[1]);
    if (!(s.weight > 0)) continue;
    const Rgb V = t.open < 1.0f ? tracer_.transmittance(s.ray) : Rgb(1.0f);
    const float K = flat ? t.K : elements_.shape(t.sender).area * static_cast<float>(s.weight);
    if (!isBlack(V)) visit(t.sender, gain * K * V);
    return t.open < 1.0f ? 1 : 0;
  }
  return 0;
}

std::size_t IndirectSampler::atLeaf(ElementId leaf, int rays, std::vector<LeafTransfer>& out) const {
  const ElementGeometry& g = elements_.shape(leaf);
  const ElementNodes& n = elements_.nodes[leaf.index()];
  const float exposed = exposure_.of(leaf);
  // What is in plain view has no noise that would hide an error of K.
  const auto kernelOf = [&](ElementId s, bool clear) {
    const float reach = kNear * g.radius + elements_.shape(s).radius;
    const Vec3f d = elements_.shape(s).center - g.center;
    if (!clear && elements_.at(leaf).flat && glm::dot(d, d) > reach * reach)
      return kernelAtPoint(elements_, scene_, g.center, g.normal, s);
    double K = 0;
    for (int i = 0; i < 4; ++i)
      if (n.weight[i] > 0) K += n.weight[i] * kernelAtPoint(elements_, scene_, n.position[i], n.normal[i], s);
    return K;
  };
  return sample(
      leaf, {g.center, g.normal}, rays, kernelOf,
      [&](double a, double b) { return samplePatch(elements_, scene_, leaf, a, b); },
      [&](ElementId from, const Rgb& T) {
        out.push_back({from, T / exposed});
      });
}

Rgb IndirectSampler::atPoint(ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const {
  const PatchPoint x{p, normal};
  RgbSum E(0.0);
  sample(
      leaf, x, rays, [&](ElementId s, bool) { return kernelAtPoint(elements_, scene_, p, normal, s); },
      [&](double, double) { return x; },
      [&](ElementId from, const Rgb& T) { E += RgbSum(T * elements_.radiometry[from.index()].B); });
  return Rgb(E);
}

}  // namespace deltalux
