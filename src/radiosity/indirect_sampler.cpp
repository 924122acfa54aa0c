#include "radiosity/indirect_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/sender_sampling.hpp"

namespace deltalux {

namespace {

constexpr float kNear = 4.0f;  // in radii of leaf and sender: nearer than this, K is taken at all nodes of the leaf
constexpr float kLeastKernel = 0.1f;    // relative to that of a sender that faces the place with a quarter of its area
constexpr float kUneven = 2.0f;         // rays of clusters and curved senders, whose points differ most, against others
constexpr float kPartsShare = 2.0f;     // rays of a sender above which it is taken apart
constexpr int kFacingTries = 16;        // more points of a sender when some face away
constexpr std::size_t kMostRays = 128;  // for one link

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
    : scene_(scene), elements_(elements), tracer_(tracer), links_(links) {}

float IndirectSampler::strength(ElementId receiver, ElementId sender) const {
  if (!elements_.isCluster(sender)) return gray(elements_.radiometry[sender.index()].B);
  const Vec3f w = elements_.shape(receiver).center - elements_.shape(sender).center;
  const DirectionalRgb& intensity = elements_.cluster(sender).intensity;
  const float mean = 0.28209479f * std::max(0.0f, gray(intensity.c[0]));
  return glm::length(w) > 0 ? std::max(gray(intensity.at(glm::normalize(w))), 0.25f * mean) : mean;
}

template <class KernelOf>
IndirectSampler::Term IndirectSampler::term(ElementId leaf, ElementId sender, float open,
                                            const KernelOf& kernelOf) const {
  Term t{sender, 0.0f, open, 0.0f};
  const float B = strength(leaf, sender);
  if (!(B > 0)) return t;
  t.K = static_cast<float>(kernelOf(sender));
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
  const float most = kPartsShare * total / static_cast<float>(rays);
  std::vector<Term> parts;
  while (!whole.empty()) {
    const Term t = whole.back();
    whole.pop_back();
    if (t.weight <= most || elements_.isLeaf(t.sender)) {
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

template <class PointAt, class Visit>
std::size_t IndirectSampler::sample(const std::vector<Term>& terms, int rays, std::uint64_t key, const PointAt& pointAt,
                                    const Visit& visit) const {
  const auto known = [&](const Term& t) { return t.open >= 1.0f && exact(t.sender) && elements_.isLeaf(t.sender); };
  float total = 0;
  for (const Term& t : terms) total += known(t) ? 0.0f : t.weight;
  std::size_t traced = 0;
  for (const Term& t : terms) {
    if (known(t)) {
      visit(t.sender, Rgb(t.K));
      continue;
    }
    const float share = static_cast<float>(rays) * t.weight / total;
    const std::uint64_t own = combineKeys(key, elements_.key[t.sender.index()]);
    if (share < 1.0f) {
      if (toUnit(mix64(combineKeys(own, 1))) < share) traced += sampleTerm(t, 1, 1.0f / share, own, pointAt, visit);
      continue;
    }
    const auto n = std::min<std::size_t>(kMostRays, static_cast<std::size_t>(std::ceil(share)));
    traced += sampleTerm(t, static_cast<int>(n), 1.0f, own, pointAt, visit);
  }
  return traced;
}

template <class PointAt, class Visit>
std::size_t IndirectSampler::sampleTerm(const Term& t, int rays, float gain, std::uint64_t key, const PointAt& pointAt,
                                        const Visit& visit) const {
  const bool flat = exact(t.sender);
  const int most = flat ? rays + kFacingTries : rays;
  struct Seen {
    ElementId leaf;
    Rgb T;
  };
  std::array<Seen, kMostRays> seen;
  double weights = 0;
  int used = 0;
  std::size_t traced = 0;
  for (int i = 0; i < most && used < rays; ++i) {
    const auto u = stratified4(key, i);
    const SenderSample s = sampleLeafOf(elements_, scene_, pointAt(u[2], u[3]), t.sender, u[0], u[1]);
    if (!(s.weight > 0)) {
      if (!flat) ++used, seen[used - 1].leaf = {};
      continue;
    }
    weights += s.weight;
    Rgb V(1.0f);
    if (t.open < 1.0f &&
        !isBlack(elements_.radiometry[s.leaf.index()].rho + elements_.radiometry[s.leaf.index()].tau)) {
      V = tracer_.transmittance(s.ray);
      ++traced;
    }
    seen[static_cast<std::size_t>(used++)] = {s.leaf, static_cast<float>(s.weight) * V};
  }
  if (!(weights > 0)) return traced;
  const float scale =
      gain * (flat ? static_cast<float>(t.K / weights) : elements_.shape(t.sender).area / static_cast<float>(used));
  for (int i = 0; i < used; ++i) {
    const Seen& s = seen[static_cast<std::size_t>(i)];
    if (s.leaf.valid() && !isBlack(s.T)) visit(s.leaf, scale * s.T);
  }
  return traced;
}

std::size_t IndirectSampler::atLeaf(ElementId leaf, int rays, std::vector<LeafTransfer>& out) const {
  const ElementGeometry& g = elements_.shape(leaf);
  const ElementNodes& n = elements_.nodes[leaf.index()];
  const auto kernelOf = [&](ElementId s) {
    const float reach = kNear * (g.radius + elements_.shape(s).radius);
    const Vec3f d = elements_.shape(s).center - g.center;
    if (elements_.at(leaf).flat && glm::dot(d, d) > reach * reach)
      return kernelAtPoint(elements_, scene_, g.center, g.normal, s);
    double K = 0;
    for (int i = 0; i < 4; ++i)
      if (n.weight[i] > 0) K += n.weight[i] * kernelAtPoint(elements_, scene_, n.position[i], n.normal[i], s);
    return K;
  };
  return sample(
      terms(leaf, rays, kernelOf), rays, elements_.key[leaf.index()],
      [&](double a, double b) { return samplePatch(elements_, scene_, leaf, a, b); },
      [&](ElementId from, const Rgb& T) {
        out.push_back({from, T});
      });
}

Rgb IndirectSampler::atPoint(ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const {
  const PatchPoint x{p, normal};
  RgbSum E(0.0);
  sample(
      terms(leaf, rays, [&](ElementId s) { return kernelAtPoint(elements_, scene_, p, normal, s); }), rays,
      elements_.key[leaf.index()], [&](double, double) { return x; },
      [&](ElementId from, const Rgb& T) { E += RgbSum(T * elements_.radiometry[from.index()].B); });
  return Rgb(E);
}

}  // namespace deltalux
