// How the direct row of a leaf follows a move: lights whose links are others are sampled anew, by as many rays for a
// weight as the row has; of the others only those whose rays meet what moved.
#include <algorithm>

#include "base/sort_unique.hpp"
#include "paper/links_below.hpp"
#include "radiosity/direct_sampler.hpp"
#include "radiosity/row_terms.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kMostDirectGone = 0.5f;  // of a row's rays: with more to deal anew, all may be
constexpr float kSamePlan = 2.0f;  // factor within which a row's weight stands, for its rays to be shared out well

/// Weight that a term was dealt its rays for, in rays.
float raysOf(const RowTerm& t) { return static_cast<float>(t.index) / t.gain; }

}  // namespace

bool DirectSampler::meets(hierarchy::ElementId leaf, const RowTerm& t, const paper::SpaceChange& space) const {
  const hierarchy::ElementGeometry &r = elements_.shape(leaf), &s = elements_.shape(t.sender);
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

/// Whether changed links cover the term by now.
bool DirectSampler::dealtOver(const paper::LinkChanges& links, std::span<const hierarchy::LinkId> changed,
                              const paper::SpaceChange& space, const RowTerm& t) const {
  if (paper::changeOf(links, t.link) == paper::LinkChange::Changed || space.moved(t.sender)) return true;
  return links_[t.link].state == hierarchy::LinkState::Interior &&
         std::any_of(changed.begin(), changed.end(), [&](hierarchy::LinkId id) {
           return paper::holds(elements_, links_[paper::toWholeLight(links_, elements_, id)].sender, t.sender);
         });
}

DirectSampler::Passage DirectSampler::tracedAgain(hierarchy::ElementId leaf, const RowTerm& t,
                                                  std::uint64_t& traced) const {
  Term same;
  same.sender = t.sender, same.curved = curved(t.sender);
  setKernel(leaf, same);
  return pass(leaf, same, t.index, rayKey(leaf, t.sender), traced);
}

/// Terms whose rays meet what moved, in ascending order.
std::vector<std::uint32_t> DirectSampler::meeting(hierarchy::ElementId leaf, const paper::LinkChanges& links,
                                                  const paper::SpaceChange& space, const TransferRow& row) const {
  std::vector<std::uint32_t> out;
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  if (elements_.at(leaf).flat && space.behind(g.center, g.normal)) return out;
  for (std::uint32_t i = 0; i < row.terms.size(); ++i) {
    const RowTerm& t = row.terms[i];
    if (!t.clear && paper::changeOf(links, t.link) != paper::LinkChange::None && meets(leaf, t, space))
      out.push_back(i);
  }
  return out;
}

DirectUpdate DirectSampler::update(hierarchy::ElementId leaf, int rays, const paper::LinkChanges& links,
                                   std::span<const hierarchy::LinkId> changed, const paper::SpaceChange& space,
                                   TransferRow& row, std::uint64_t& traced) const {
  DirectUpdate update;
  const std::vector<std::uint32_t> again = meeting(leaf, links, space, row);
  update.any = !again.empty() || !changed.empty();
  if (!update.any) return update;
  TransferRow next;
  next.weightPerRay = row.weightPerRay, next.reach = row.reach;
  next.terms.reserve(row.terms.size()), next.transfers.reserve(row.transfers.size());
  float gone = 0;
  auto a = again.begin();
  forEachTerm(row, [&](std::uint32_t i, const RowTerm& t, std::span<const LeafTransfer> transfers) {
    const bool retraced = a != again.end() && *a == i;
    a += retraced;
    if (!changed.empty() && dealtOver(links, changed, space, t)) {
      gone += raysOf(t);
      return;
    }
    next.terms.push_back(t);
    if (!retraced) {
      next.transfers.insert(next.transfers.end(), transfers.begin(), transfers.end());
      return;
    }
    const Passage found = tracedAgain(leaf, t, traced);
    remember(t.sender, found, next);
    const Rgb T = t.gain * found.T, before = transfers.empty() ? Rgb(0.0f) : transfers[0].T;
    update.change += std::abs(gray((T - before) * elements_.radiometry[t.sender.index()].B));
    next.terms.back().count = !isBlack(T);
    if (!isBlack(T)) next.transfers.push_back({t.sender, T});
  });
  if (!changed.empty() && !sampleChanged(leaf, rays, changed, gone, next, update, traced)) {
    update.anew = true;
    return update;
  }
  row = std::move(next);
  return update;
}

/// Appends terms over changed links; false when the row should rather be sampled anew as a whole. `gone`: the rays of
/// the terms that were taken out.
bool DirectSampler::sampleChanged(hierarchy::ElementId leaf, int rays, std::span<const hierarchy::LinkId> changed,
                                  float gone, TransferRow& row, DirectUpdate& update, std::uint64_t& traced) const {
  const float all = static_cast<float>(rays);
  if (gone > kMostDirectGone * all) return false;
  std::vector<hierarchy::LinkId> active;
  std::vector<hierarchy::LinkId> tops;
  for (const hierarchy::LinkId id : changed) tops.push_back(paper::toWholeLight(links_, elements_, id));
  sortUnique(tops);
  for (const hierarchy::LinkId top : tops) paper::activeBelow(links_, elements_, top, leaf, active);
  const std::vector<Term> fresh = terms(leaf, senders_.over(active, leaf));
  float weight = 0;
  for (const Term& t : fresh) weight += t.known() ? 0.0f : t.weight;
  if (row.weightPerRay > 0) {
    const float now = all - gone + weight / row.weightPerRay;
    if (now > kSamePlan * all || kSamePlan * now < all) return false;
  } else {
    row.weightPerRay = weight / all;
  }
  Sampled sampled;
  deal(leaf, fresh, row.weightPerRay, sampled);
  traced += sampled.rays;
  update.variation = variation(leaf, sampled);
  row.reach.add(sampled.row.reach);
  row.terms.insert(row.terms.end(), sampled.row.terms.begin(), sampled.row.terms.end());
  row.transfers.insert(row.transfers.end(), sampled.row.transfers.begin(), sampled.row.transfers.end());
  return true;
}

}  // namespace deltalux::radiosity
