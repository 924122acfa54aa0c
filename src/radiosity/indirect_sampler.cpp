#include "radiosity/indirect_sampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "paper/facing.hpp"
#include "paper/kernel.hpp"
#include "paper/links_below.hpp"
#include "paper/oracle.hpp"
#include "paper/sender_sampling.hpp"
#include "paper/visibility.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kLeastKernel = 0.1f;  // relative to that of a sender that faces the place with a quarter of its area
constexpr float kNoneFaces = 0.25f;   // of that where no node does face it
constexpr float kUneven = 2.0f;       // rays of clusters and curved senders, whose points differ most, against others
constexpr float kPartsShare = 2.0f;   // rays of a sender above which it is taken apart
constexpr float kWholeShare = 0.25f;  // the same for senders that need no ray: their radiosity counts as even
constexpr float kCloseShare = 0.15f;  // of the most that a close sender could bring, in closeWeight()
constexpr float kLookedAt = 8;        // times its rays' worth: chance that what changed is looked at

/// The mean of d^2 over a leaf that its parts would see a sender by: a long one that the sender is close to is seen
/// from there, not from its middle.
float squaredDistance(const hierarchy::ElementGeometry& leaf, const Vec3f& x,
                      const hierarchy::ElementGeometry& sender) {
  const Vec3f d = sender.center - x;
  const float squared = std::max(glm::dot(d, d), sender.radius * sender.radius);
  const Vec3f near = sender.center - glm::clamp(sender.center, leaf.lower, leaf.upper);
  const float width = leaf.area / std::max(leaf.radius, 1e-30f);
  const float close = std::max({glm::length(near), sender.radius, width});
  return std::min(squared, close * std::max(close, leaf.radius));
}

/// Transfer that clusters and curved senders are credited with, of the kernel K over their nodes: those may all face
/// away where some part does not.
float atLeast(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const Vec3f& x,
              hierarchy::ElementId sender, float K) {
  const hierarchy::ElementGeometry& g = elements.shape(sender);
  const float least = kLeastKernel * (K > 0 ? 1.0f : kNoneFaces);
  return std::max(K, least * (elements.isCluster(sender) ? 1.0f : g.area / float(kPi)) /
                         squaredDistance(elements.shape(leaf), x, g));
}

}  // namespace

IndirectSampler::IndirectSampler(const Scene& scene, const hierarchy::Elements& elements, const hierarchy::Links& links,
                                 const tracing::RayTracer& tracer)
    : scene_(scene), elements_(elements), tracer_(tracer), links_(links), grid_(elements) {}

/// Radiosity that senders are credited with; so what is all but dark gets no few heavy samples either.
float IndirectSampler::faintest(hierarchy::ElementId receiver) const {
  const hierarchy::ElementLight& here = elements_.radiometry[receiver.index()];
  return static_cast<float>(paper::kFaintLight) * std::max(gray(here.indirect), here.tolerance);
}

/// What all around the place together are worth at present: rays dealt out later go by weights of their own time.
float IndirectSampler::level(hierarchy::ElementId receiver) const {
  constexpr float kLeast = 1e-20f;
  return std::max(gray(elements_.radiometry[receiver.index()].indirect) + faintest(receiver), kLeast);
}

float IndirectSampler::strength(hierarchy::ElementId receiver, hierarchy::ElementId sender) const {
  const float faint = faintest(receiver);
  if (!elements_.isCluster(sender)) {
    const hierarchy::ElementLight& there = elements_.radiometry[sender.index()];
    return isBlack(there.rho + there.tau) ? 0.0f : gray(there.B) + faint;
  }
  const Vec3f w = elements_.shape(receiver).center - elements_.shape(sender).center;
  const hierarchy::DirectionalRgb& intensity = elements_.cluster(sender).intensity;
  const float mean = 0.28209479f * std::max(0.0f, gray(intensity.c[0]));
  const float facing = glm::length(w) > 0 ? std::max(gray(intensity.at(glm::normalize(w))), 0.25f * mean) : mean;
  return facing + faint * elements_.shape(sender).area / (4 * float(kPi));
}

bool IndirectSampler::exact(hierarchy::ElementId sender) const {
  return elements_.isPatch(sender) && elements_.at(sender).flat;
}

/// Whether nothing can come from a sender that may be credited with more than its nodes show.
bool IndirectSampler::averted(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
  const hierarchy::ElementGeometry &r = elements_.shape(leaf), &s = elements_.shape(sender);
  return paper::turnsAway(r, s) || (elements_.isPatch(sender) && paper::turnsAway(s, r));
}

template <class KernelOf>
IndirectSampler::Term IndirectSampler::term(hierarchy::ElementId leaf, hierarchy::LinkId link,
                                            hierarchy::ElementId sender, float open, const KernelOf& kernelOf) const {
  Term t{link, sender, 0.0f, open, 0.0f};
  const float B = strength(leaf, sender);
  const bool measured = !exact(sender) || (open < 1.0f && measures(leaf, sender));  // by rays: K only shares them out
  if (!(B > 0) || (measured && averted(leaf, sender))) return t;
  t.K = static_cast<float>(kernelOf(sender, open >= 1.0f));
  if (measured) t.K = atLeast(elements_, leaf, elements_.shape(leaf).center, sender, t.K);
  float K = t.K;  // of pairs of points, by chance: then what nodes say counts, too
  if (exact(sender) && open < 1.0f && isClosePatch(leaf, sender)) K = std::max(K, kernelOverNodes(leaf, sender));
  t.weight = K * B * std::sqrt(open) * (exact(sender) ? 1.0f : kUneven);
  return t;
}

template <class KernelOf>
void IndirectSampler::add(hierarchy::ElementId leaf, hierarchy::LinkId id, const KernelOf& kernelOf,
                          std::vector<Term>& out) const {
  const hierarchy::Link& l = links_[id];
  if (!l.carries() || l.fromLight) return;
  const Term t = term(leaf, id, l.sender, paper::openness(l), kernelOf);
  if (t.weight > 0) out.push_back(t);
}

template <class KernelOf>
std::vector<IndirectSampler::Term> IndirectSampler::allTerms(hierarchy::ElementId leaf,
                                                             const KernelOf& kernelOf) const {
  std::vector<Term> all;
  for (hierarchy::ElementId r = leaf; r.valid(); r = elements_.at(r).parent)
    for (hierarchy::LinkId id = links_.first(r, false); id.valid(); id = links_[id].nextArriving)
      add(leaf, id, kernelOf, all);
  return all;
}

/// What a term of clusters or curved patches close by counts as when it is asked whether to take it apart: where most
/// of it comes from few places, its kernel, of nodes, may miss those.
float IndirectSampler::closeWeight(hierarchy::ElementId leaf, const Term& t) const {
  if (exact(t.sender) || !areClose(elements_, leaf, t.sender)) return 0.0f;
  const float A = elements_.shape(t.sender).area, most = elements_.isCluster(t.sender) ? 4 * float(kPi) : A;
  const float K = kCloseShare * most / std::max(A, elements_.shape(leaf).area);
  return t.weight / t.K * K;
}

template <class KernelOf>
std::vector<IndirectSampler::Term> IndirectSampler::apart(hierarchy::ElementId leaf, std::vector<Term> whole, float ray,
                                                          const KernelOf& kernelOf) const {
  std::vector<Term> parts;
  while (!whole.empty()) {
    const Term t = whole.back();
    whole.pop_back();
    const float enough = (known(t) ? kWholeShare : kPartsShare) * ray;
    if (elements_.isLeaf(t.sender) || (t.weight <= enough && closeWeight(leaf, t) <= enough)) {
      parts.push_back(t);
      continue;
    }
    for (std::size_t i = elements_.at(t.sender).childCount; i-- > 0;) {
      const Term part = term(leaf, t.link, elements_.child(t.sender, i), t.open, kernelOf);
      if (part.weight > 0) whole.push_back(part);
    }
  }
  return parts;
}

/// What a part of a sender may bring to the middle of the leaf; of flat parts, by their centre alone; of what is curved
/// and close, to all of the leaf.
float IndirectSampler::guess(hierarchy::ElementId leaf, const hierarchy::PatchPoint& x,
                             hierarchy::ElementId part) const {
  const float B = strength(leaf, part);
  if (!(B > 0) || averted(leaf, part)) return 0.0f;
  if (!exact(part)) {
    const float K = isClosePatch(leaf, part)
                        ? kernelOverPairs(leaf, part, 1)
                        : static_cast<float>(paper::kernelAtPoint(elements_, scene_, x.position, x.normal, part));
    return kUneven * B * atLeast(elements_, leaf, x.position, part, K);
  }
  const hierarchy::ElementGeometry& g = elements_.shape(part);
  const Vec3f d = g.center - x.position;
  const float squared = glm::dot(d, d);
  const auto K =
      static_cast<float>(paper::pointKernel(elements_, scene_, x.position, x.normal, part, g.center, g.normal));
  return B * atLeast(elements_, leaf, x.position, part, K * g.area * squared / (squared + g.area / float(kPi)));
}

template <class KernelOf, class Visit>
void IndirectSampler::dealBelow(hierarchy::ElementId leaf, const hierarchy::PatchPoint& x, const Term& t,
                                double expected, int rays, const Roundings& roundings, const KernelOf& kernelOf,
                                const Visit& visit) const {
  if (elements_.isLeaf(t.sender)) {
    if (t.K > 0)
      for (int i = 0; i < rays; ++i) visit(Dealt{t, static_cast<float>(1.0 / expected), i});
    return;
  }
  std::vector<float> guesses;
  double total = 0;
  for (std::size_t i = 0; i < elements_.at(t.sender).childCount; ++i)
    total += guesses.emplace_back(guess(leaf, x, elements_.child(t.sender, i)));
  double rest = total;
  for (std::size_t i = 0; i < guesses.size() && rays > 0; ++i) {
    if (!(guesses[i] > 0)) continue;
    const hierarchy::ElementId child = elements_.child(t.sender, i);
    const int own = shareOf(rays, guesses[i], rest, roundings.of(elements_.key[child.index()]));
    rays -= own, rest -= guesses[i];
    if (own == 0) continue;
    Term part{t.link, child, 0.0f, t.open, 0.0f};
    if (elements_.isLeaf(child)) part = term(leaf, t.link, child, t.open, kernelOf);
    dealBelow(leaf, x, part, expected * guesses[i] / total, own, roundings, kernelOf, visit);
  }
}

template <class KernelOf, class Visit>
void IndirectSampler::deal(hierarchy::ElementId leaf, const hierarchy::PatchPoint& center,
                           const std::vector<Term>& terms, double step, int rays, const KernelOf& kernelOf,
                           const Visit& visit) const {
  std::vector<RayShare> shares;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    if (known(terms[i]))
      visit(Dealt{terms[i], 1.0f, 0});
    else
      shares.push_back({grid_.code(elements_.shape(terms[i].sender).center), elements_.key[terms[i].sender.index()],
                        static_cast<std::uint32_t>(i), terms[i].weight});
  }
  const Roundings roundings(elements_, leaf);
  dealOut(shares, rays, roundings, [&](std::uint32_t i, int own) {
    dealBelow(leaf, center, terms[i], terms[i].weight / step, own, roundings, kernelOf, visit);
  });
}

TransferRow IndirectSampler::atLeaf(hierarchy::ElementId leaf, int rays, std::uint64_t& traced) const {
  const auto kernelOf = [&](hierarchy::ElementId s, bool clear) { return kernelAtLeaf(leaf, s, clear); };
  std::vector<Term> whole = allTerms(leaf, kernelOf);
  float sum = 0;
  for (const Term& t : whole) sum += t.weight;
  const auto terms = apart(leaf, std::move(whole), sum / static_cast<float>(rays), kernelOf);
  double total = 0;
  for (const Term& t : terms) total += known(t) ? 0.0f : t.weight;
  TransferRow row;
  const double step = (total > 0 ? total : sum) / rays;
  row.weightPerRay = static_cast<float>(step / level(leaf));
  const hierarchy::PatchPoint center{elements_.shape(leaf).center, elements_.shape(leaf).normal};
  deal(leaf, center, terms, step, rays, kernelOf, [&](const Dealt& d) { append(leaf, d, row, traced); });
  row.terms.shrink_to_fit();
  row.transfers.shrink_to_fit();
  row.rays.shrink_to_fit();
  return row;
}

bool IndirectSampler::dealChanged(hierarchy::ElementId leaf, std::span<const hierarchy::LinkId> changed, int most,
                                  TransferRow& row, std::uint64_t& traced) const {
  const auto kernelOf = [&](hierarchy::ElementId s, bool clear) { return kernelAtLeaf(leaf, s, clear); };
  std::vector<hierarchy::LinkId> active;
  for (const hierarchy::LinkId top : changed) paper::activeBelow(links_, elements_, top, leaf, active);
  std::vector<Term> whole;
  for (const hierarchy::LinkId id : active) add(leaf, id, kernelOf, whole);
  const hierarchy::PatchPoint center{elements_.shape(leaf).center, elements_.shape(leaf).normal};
  // As many rays for a weight as the row has, and no more than a row has.
  float sum = 0;
  for (const Term& t : whole) sum += t.weight;
  const float step = std::max(row.weightPerRay * level(leaf), sum / static_cast<float>(most));
  if (!(step > 0)) return false;
  // What is left over is a ray by chance, by the key of the place and of what has changed: another one each time. Where
  // all is worth a small part of a ray, chance comes first.
  std::uint64_t key = elements_.key[leaf.index()];
  for (const Term& t : whole) key = combineKeys(key, elements_.key[t.sender.index()]);
  const bool sure = std::any_of(whole.begin(), whole.end(), [](const Term& t) { return t.open >= 1.0f; });
  const float looked = sure ? 1.0f : std::min(1.0f, kLookedAt * sum / step);
  if (!(toUnit(mix64(combineKeys(key, 1))) < looked)) return false;
  const auto terms = apart(leaf, std::move(whole), step, kernelOf);
  double unknown = 0;
  for (const Term& t : terms) unknown += known(t) ? 0.0f : t.weight;
  // Taken apart, what changed may weigh many times what it did as a whole.
  const double shared = std::max(double(step), unknown / (double(most) * looked));
  const int rays = static_cast<int>(unknown / (shared * looked) + toUnit(mix64(key)));
  const std::size_t before = row.transfers.size();
  deal(leaf, center, terms, shared, rays, kernelOf, [&](const Dealt& d) { append(leaf, d, row, traced); });
  return row.transfers.size() > before;
}

template <class Visit>
void IndirectSampler::gatherAt(hierarchy::ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays,
                               const Visit& visit) const {
  const hierarchy::PatchPoint x{p, normal};
  const auto kernelOf = [&](hierarchy::ElementId s, bool) {
    return static_cast<float>(paper::kernelAtPoint(elements_, scene_, p, normal, s));
  };
  std::vector<Term> whole = allTerms(leaf, kernelOf);
  float sum = 0;
  for (const Term& t : whole) sum += t.weight;
  const auto terms = apart(leaf, std::move(whole), sum / static_cast<float>(rays), kernelOf);
  double total = 0;
  for (const Term& t : terms) total += known(t) ? 0.0f : t.weight;
  std::uint64_t traced = 0;
  deal(leaf, x, terms, total / rays, rays, kernelOf, [&](const Dealt& d) {
    const auto s = known(d.term) ? paper::SenderSample{} : shoot(leaf, d.term.sender, d.index, &x);
    const Rgb T = find(d, s, traced).T;
    visit(d.term.sender, T * elements_.radiometry[d.term.sender.index()].B);
  });
}

Rgb IndirectSampler::atPoint(hierarchy::ElementId leaf, const Vec3f& p, const Vec3f& normal, int rays) const {
  RgbSum sum(0.0);
  gatherAt(leaf, p, normal, rays, [&](hierarchy::ElementId, const Rgb& E) { sum += RgbSum(E); });
  return Rgb(sum);
}

std::vector<IndirectSampler::Share> IndirectSampler::sharesAtPoint(hierarchy::ElementId leaf, const Vec3f& p,
                                                                   const Vec3f& normal, int rays) const {
  std::vector<Share> shares;
  gatherAt(leaf, p, normal, rays, [&](hierarchy::ElementId sender, const Rgb& E) {
    if (!isBlack(E)) shares.push_back({sender, E});
  });
  return shares;
}

}  // namespace deltalux::radiosity
