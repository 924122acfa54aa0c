// What a move does to a row of indirect light: terms over changed links go, and those of links that stand are looked at
// in the directions in which something has moved.
#include <algorithm>
#include <cmath>
#include <utility>

#include "paper/links_below.hpp"
#include "paper/visibility.hpp"
#include "radiosity/indirect_sampler.hpp"
#include "radiosity/moved_rays.hpp"
#include "radiosity/row_terms.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kMostGone = 0.5f;   // of the rays of a leaf that has moved: with fewer left, all are dealt anew
constexpr double kUnevenRow = 5.0;  // so they are when the mean square of what each may bring is this many shares'
constexpr std::size_t kMostInherited = 2;  // times the rays that a leaf deserves: more cost more than new ones

}  // namespace

std::vector<IndirectSampler::Again> IndirectSampler::meeting(hierarchy::ElementId leaf, const paper::SpaceChange& space,
                                                             const TransferRow& row) const {
  std::vector<Again> out;
  const hierarchy::ElementGeometry& r = elements_.shape(leaf);
  if (elements_.at(leaf).flat && space.behind(r.center, r.normal)) return out;
  std::vector<std::uint32_t> candidates;
  meetsRays(space, r, row.rays, candidates);
  // Senders that moved, behind what blocks their rays or without one.
  const auto met = static_cast<std::ptrdiff_t>(candidates.size());
  if (space.meets(row.reach.objects))
    for (std::uint32_t i = 0; i < row.terms.size(); ++i)
      if (blocked(row.rays[i]) && space.moved(row.terms[i].sender)) candidates.push_back(i);
  std::inplace_merge(candidates.begin(), candidates.begin() + met, candidates.end());
  candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
  for (const std::uint32_t i : candidates) {
    const RowTerm& t = row.terms[i];
    const bool moved = space.moved(t.sender);
    if (!moved) {
      const hierarchy::ElementGeometry& s = elements_.shape(t.sender);
      if (t.clear || !space.meets(r.center, r.radius, s.center, s.radius)) continue;
    }
    const paper::SenderSample sample = t.clear && exact(t.sender) ? paper::SenderSample{} : shootOf(leaf, t);
    // Where the sender has been split since, it is another ray.
    const bool another = !elements_.isLeaf(t.sender);
    if (moved || (sample.leaf.valid() && (another || space.meets(sample.ray)))) out.push_back({i, sample});
  }
  return out;
}

bool IndirectSampler::update(hierarchy::ElementId leaf, const paper::LinkChanges& links,
                             std::span<const hierarchy::LinkId> changed, const paper::SpaceChange& space, int rays,
                             TransferRow& row, std::uint64_t& traced) const {
  if (space.hiddenFrom(leaf) && !space.moved(leaf) && turn(leaf, links, changed, space, row)) return false;
  const bool gone = dropStale(links, changed, row);
  const std::vector<Again> again = space.moved(leaf) ? allOf(leaf, row) : meeting(leaf, space, row);
  if (space.moved(leaf)) {
    if (!suits(leaf, again, rays, row)) {
      row = atLeaf(leaf, rays, traced);
      return true;
    }
    row.reach = {};
  }
  const bool other = retrace(leaf, again, row, traced);
  const bool dealt = !changed.empty() && dealChanged(leaf, changed, rays, row, traced);
  return gone || other || dealt;
}

TransferRow IndirectSampler::inherited(hierarchy::ElementId leaf, const TransferRow& from,
                                       const paper::LinkChanges& links, std::span<const hierarchy::LinkId> changed,
                                       int rays, std::uint64_t& traced) const {
  if (from.terms.size() > kMostInherited * static_cast<std::size_t>(rays)) return atLeaf(leaf, rays, traced);
  TransferRow row = from;
  dropStale(links, changed, row);
  const std::vector<Again> again = allOf(leaf, row);
  if (!suits(leaf, again, rays, row)) return atLeaf(leaf, rays, traced);
  row.reach = {};
  retrace(leaf, again, row, traced);
  if (!changed.empty()) dealChanged(leaf, changed, rays, row, traced);
  return row;
}

/// Takes the terms over links that are others by now out of a row; whether they brought anything.
bool IndirectSampler::dropStale(const paper::LinkChanges& links, std::span<const hierarchy::LinkId> changed,
                                TransferRow& row) const {
  const auto stale = [&](const RowTerm& t) {
    const paper::LinkChange change = paper::changeOf(links, t.link);
    return change == paper::LinkChange::Changed || (change == paper::LinkChange::Touched && coveredBy(changed, t));
  };
  return !changed.empty() && drop(row, stale) > 0;
}

/// Whether the rays that were dealt elsewhere will do here: there are enough of them, and none brings too much.
bool IndirectSampler::suits(hierarchy::ElementId leaf, std::span<const Again> again, int rays,
                            const TransferRow& row) const {
  return static_cast<float>(row.terms.size()) >= kMostGone * static_cast<float>(rays) && !uneven(leaf, again, row);
}

/// The row of a leaf from which all that moved is hidden, before and after, brings what it did, over the links that
/// there are now. False where it must be looked at all the same.
bool IndirectSampler::turn(hierarchy::ElementId leaf, const paper::LinkChanges& links,
                           std::span<const hierarchy::LinkId> changed, const paper::SpaceChange& space,
                           TransferRow& row) const {
  if (!changed.empty() && !relink(leaf, links, changed, row)) return false;
  if (!space.meets(row.reach.objects)) return true;
  const bool bright = std::any_of(row.terms.begin(), row.terms.end(),
                                  [&](const RowTerm& t) { return t.count > 0 && space.moved(t.sender); });
  const hierarchy::ElementId occluder = space.occluder(leaf);
  if (bright || !occluder.valid()) return !bright;
  const hierarchy::PatchDomain& domain = elements_.domain[occluder.index()];
  const hierarchy::PlaneFrame& wall = elements_.frames[domain.frame];
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  const Vec3 from(0.5f * (g.lower + g.upper));
  // Rays to what moved, and those that it was found to block, end where it is hidden now: when that goes, they are
  // drawn again.
  std::vector<std::uint32_t> met;
  meetsRays(space, g, row.rays, met);
  std::erase_if(met, [&](std::uint32_t i) { return !blocked(row.rays[i]) || !(end(row.rays[i]) > 0); });
  for (std::uint32_t i = 0; i < row.terms.size(); ++i)
    if (space.moved(row.terms[i].sender)) met.push_back(i);
  if (std::any_of(met.begin(), met.end(), [&](std::uint32_t i) { return !elements_.isLeaf(row.terms[i].sender); }))
    return false;  // another ray, since its sender has been split
  for (const std::uint32_t i : met) {
    const RowTerm& t = row.terms[i];
    const tracing::Ray ray = shootOf(leaf, t).ray;
    if (!space.moved(t.sender) && !space.meets(ray)) continue;
    const Vec3 origin(ray.origin), d = double(ray.tFar) * Vec3(ray.direction);
    const double at = glm::dot(wall.origin - origin, wall.normal) / glm::dot(d, wall.normal);
    if (at > 0 && at < 1) row.rays[i] = rayCode(Vec3f(at * (origin + d - from)), true);
  }
  row.reach.objects.add(scene_, domain.primitive);
  return true;
}

/// Gives terms over links that are no more those that cover them now. False where that is not all there is to it.
bool IndirectSampler::relink(hierarchy::ElementId leaf, const paper::LinkChanges& links,
                             std::span<const hierarchy::LinkId> changed, TransferRow& row) const {
  const auto covers = [&](hierarchy::LinkId id, const RowTerm& t) {
    const hierarchy::Link& l = links_[id];
    return l.state != hierarchy::LinkState::Free && paper::holds(elements_, l.receiver, leaf) &&
           paper::holds(elements_, l.sender, t.sender);
  };
  std::vector<hierarchy::LinkId> active;
  for (RowTerm& t : row.terms) {
    if (paper::changeOf(links, t.link) != paper::LinkChange::Changed) continue;
    if (!covers(t.link, t)) {
      if (active.empty())
        for (const hierarchy::LinkId top : changed) paper::activeBelow(links_, elements_, top, leaf, active);
      const auto now = std::find_if(active.begin(), active.end(), [&](hierarchy::LinkId id) { return covers(id, t); });
      if (now == active.end()) return false;
      t.link = *now;
    }
    if (t.clear && links_[t.link].visibility != hierarchy::Visibility::Clear) return false;
  }
  return true;
}

/// The rays of all terms, from where the leaf is now.
std::vector<IndirectSampler::Again> IndirectSampler::allOf(hierarchy::ElementId leaf, const TransferRow& row) const {
  std::vector<Again> out;
  out.reserve(row.terms.size());
  for (std::uint32_t i = 0; i < row.terms.size(); ++i) {
    const RowTerm& t = row.terms[i];
    out.push_back({i, t.clear && exact(t.sender) ? paper::SenderSample{} : shootOf(leaf, t)});
  }
  return out;
}

/// Whether what the rays may bring differs too much: each one's share when they were dealt.
bool IndirectSampler::uneven(hierarchy::ElementId leaf, std::span<const Again> again, const TransferRow& row) const {
  const double share = double(row.weightPerRay) * level(leaf);
  double sum = 0;
  for (const Again& a : again) {
    const RowTerm& t = row.terms[a.term];
    if (t.clear || !a.sample.leaf.valid()) continue;
    const double K = elements_.shape(t.sender).area * a.sample.weight;
    const double x = t.gain * K * strength(leaf, t.sender) * std::sqrt(paper::openness(links_[t.link]));
    sum += x * x;
  }
  return sum > kUnevenRow * share * share * static_cast<double>(row.terms.size());
}

/// Whether a term that was dealt over a link now split is one of these links' by now. What is above a changed link has
/// been touched.
bool IndirectSampler::coveredBy(std::span<const hierarchy::LinkId> changed, const RowTerm& t) const {
  if (links_[t.link].state != hierarchy::LinkState::Interior) return false;
  return std::any_of(changed.begin(), changed.end(),
                     [&](hierarchy::LinkId id) { return paper::holds(elements_, links_[id].sender, t.sender); });
}

/// What a term brings by today's kernel. That of a flat sender is worked out only where something passes.
IndirectSampler::Found IndirectSampler::findAgain(hierarchy::ElementId leaf, const RowTerm& t,
                                                  const paper::SenderSample& sample, std::uint64_t& traced) const {
  Found found = find({{t.link, t.sender, 1.0f, t.clear ? 1.0f : 0.0f, 0.0f}, t.gain, t.index}, sample, traced);
  if (!isBlack(found.T) && exact(t.sender) && !sample.measures) found.T *= kernelAtLeaf(leaf, t.sender, t.clear);
  return found;
}

bool IndirectSampler::retrace(hierarchy::ElementId leaf, std::span<const Again> again, TransferRow& row,
                              std::uint64_t& traced) const {
  bool other = false;
  std::size_t at = 0, i = 0;
  for (const Again& a : again) {
    for (; i < a.term; ++i) at += row.terms[i].count;
    RowTerm& t = row.terms[a.term];
    const Found found = findAgain(leaf, t, a.sample, traced);
    remember(leaf, a.term, found, row);
    if (t.count == 0) {
      if (isBlack(found.T)) continue;
      row.transfers.insert(row.transfers.begin() + static_cast<std::ptrdiff_t>(at), {t.sender, Rgb(0.0f)}), t.count = 1;
    }
    Rgb& T = row.transfers[at].T;  // also where it is black by now: the next move may lift it
    other |= std::exchange(T, found.T) != found.T;
  }
  return other;
}

}  // namespace deltalux::radiosity
