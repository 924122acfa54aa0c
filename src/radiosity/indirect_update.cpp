// What a move does to a row of indirect light: terms over changed links go, and those of links that stand are looked at
// in the directions in which something has moved.
#include <algorithm>

#include "radiosity/indirect_sampler.hpp"
#include "radiosity/links_below.hpp"
#include "radiosity/row_terms.hpp"

namespace deltalux {

std::vector<IndirectSampler::Again> IndirectSampler::meeting(ElementId leaf, const SpaceChange& space,
                                                             const TransferRow& row) const {
  std::vector<Again> out;
  const ElementGeometry& r = elements_.shape(leaf);
  if (elements_.at(leaf).flat && space.behind(r.center, r.normal)) return out;
  std::vector<std::uint32_t> candidates;
  space.meetsRays(r.center, r.radius, row.directions, candidates);
  for (const std::uint32_t i : candidates) {
    const RowTerm& t = row.terms[i];
    const bool moved = space.moved(t.sender);
    if (!moved) {
      const ElementGeometry& s = elements_.shape(t.sender);
      if (t.clear || !space.meets(r.center, r.radius, s.center, s.radius)) continue;
    }
    const SenderSample sample = t.clear && exact(t.sender) ? SenderSample{} : shoot(leaf, t.sender, t.index);
    if (moved || (sample.leaf.valid() && space.meets(sample.ray))) out.push_back({i, sample});
  }
  return out;
}

bool IndirectSampler::update(ElementId leaf, const LinkChanges& links, std::span<const LinkId> changed,
                             const SpaceChange& space, TransferRow& row, std::uint64_t& traced) const {
  const std::vector<Again> again = meeting(leaf, space, row);
  if (changed.empty()) {
    retrace(leaf, again, row, traced);
    return !again.empty();
  }
  row = kept(leaf, links, changed, again, row, traced);
  dealChanged(leaf, changed, row, traced);
  return true;
}

TransferRow IndirectSampler::kept(ElementId leaf, const LinkChanges& links, std::span<const LinkId> changed,
                                  std::span<const Again> again, const TransferRow& row, std::uint64_t& traced) const {
  TransferRow next;
  next.weightPerRay = row.weightPerRay, next.reach = row.reach;
  next.terms.reserve(row.terms.size()), next.directions.reserve(row.terms.size());
  next.transfers.reserve(row.transfers.size());
  auto a = again.begin();
  forEachTerm(row, [&](std::uint32_t i, const RowTerm& t, std::span<const LeafTransfer> transfers) {
    const auto retraced = a != again.end() && a->term == i ? a++ : again.end();
    const LinkChange change = changeOf(links, t.link);
    if (change == LinkChange::Changed || (change == LinkChange::Touched && coveredBy(changed, t))) return;
    if (retraced != again.end()) {
      append(leaf, dealt(leaf, t), retraced->sample, next, traced);
      return;
    }
    next.terms.push_back(t);
    next.directions.push_back(row.directions[i]);
    next.transfers.insert(next.transfers.end(), transfers.begin(), transfers.end());
  });
  return next;
}

/// Whether a term that was dealt over a link now split is one of these links' by now. What is above a changed link has
/// been touched.
bool IndirectSampler::coveredBy(std::span<const LinkId> changed, const RowTerm& t) const {
  if (links_[t.link].state != LinkState::Interior) return false;
  return std::any_of(changed.begin(), changed.end(),
                     [&](LinkId id) { return holds(elements_, links_[id].sender, t.sender); });
}

IndirectSampler::Dealt IndirectSampler::dealt(ElementId leaf, const RowTerm& t) const {
  const float K = exact(t.sender) ? kernelAtLeaf(leaf, t.sender, t.clear) : 0.0f;
  return {{t.link, t.sender, K, t.clear ? 1.0f : 0.0f, 0.0f}, t.gain, t.index};
}

void IndirectSampler::retrace(ElementId leaf, std::span<const Again> again, TransferRow& row,
                              std::uint64_t& traced) const {
  std::size_t at = 0, i = 0;
  for (const Again& a : again) {
    for (; i < a.term; ++i) at += row.terms[i].count;
    RowTerm& t = row.terms[a.term];
    const Rgb T = transfer(dealt(leaf, t), a.sample, traced);
    remember(leaf, a.term, a.sample, row);
    if (t.count > 0)
      row.transfers[at].T = T;  // also where it is black by now: the next move may lift it
    else if (!isBlack(T))
      row.transfers.insert(row.transfers.begin() + static_cast<std::ptrdiff_t>(at), {t.sender, T}), t.count = 1;
  }
}

}  // namespace deltalux
