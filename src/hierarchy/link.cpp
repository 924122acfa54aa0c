#include "hierarchy/link.hpp"

#include <algorithm>

namespace deltalux::hierarchy {

LinkId Links::addRoot(ElementId receiver, ElementId sender, bool fromLight) {
  const LinkId id(all.size());
  all.emplace_back();
  all.back().fromLight = fromLight;
  roots.push_back(id);
  setEnds(id, receiver, sender);
  return id;
}

LinkId Links::addChildren(LinkId parent, std::size_t count) {
  LinkId firstChild(all.size());
  if (count < free.size() && !free[count].empty()) {
    firstChild = free[count].back();
    free[count].pop_back();
  } else {
    all.resize(all.size() + count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    Link& child = all[firstChild.index() + i];
    child = {};
    child.parent = parent;
    child.fromLight = all[parent.index()].fromLight;
  }
  unlist(parent);
  Link& above = all[parent.index()];
  above.state = LinkState::Interior;
  above.firstChild = firstChild;
  above.childCount = static_cast<std::uint16_t>(count);
  return firstChild;
}

void Links::setEnds(LinkId id, ElementId receiver, ElementId sender) {
  all[id.index()].receiver = receiver, all[id.index()].sender = sender;
}

std::uint8_t Links::hiddenAbove(LinkId id) const {
  const LinkId parent = all[id.index()].parent;
  if (!parent.valid()) return 0;
  const Link& above = all[parent.index()];
  if (above.visibility != Visibility::Sampled || above.sampleMask != 0) return 0;
  return static_cast<std::uint8_t>(std::min(above.hidden + 1, Link::kHidden - 1));
}

void Links::judged(LinkId id, const Link& as) {
  Link& l = all[id.index()];
  l.K = as.K, l.V = as.V;
  l.receiverSpread = as.receiverSpread, l.senderSpread = as.senderSpread, l.visibilitySpread = as.visibilitySpread;
  l.sampleMask = as.sampleMask, l.samples = as.samples, l.visibility = as.visibility, l.hidden = as.hidden;
  if (l.state != LinkState::Interior) l.state = as.state;
  if (l.carries() && !l.listed) list(id);
  if (!l.carries() && l.listed) unlist(id);
}

void Links::list(LinkId id) {
  Link& l = all[id.index()];
  const std::size_t at = 2 * l.receiver.index() + l.fromLight;
  if (at >= arriving.size()) arriving.resize(at + 1);
  l.nextArriving = arriving[at], l.previousArriving = {};
  if (arriving[at].valid()) all[arriving[at].index()].previousArriving = id;
  arriving[at] = id;
  l.listed = true;
}

void Links::unlist(LinkId id) {
  Link& l = all[id.index()];
  if (!l.listed) return;
  if (l.nextArriving.valid()) all[l.nextArriving.index()].previousArriving = l.previousArriving;
  LinkId& before = l.previousArriving.valid() ? all[l.previousArriving.index()].nextArriving
                                              : arriving[2 * l.receiver.index() + l.fromLight];
  before = l.nextArriving;
  l.nextArriving = l.previousArriving = {};
  l.listed = false;
}

void Links::listArriving() {
  arriving.clear();
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].listed = false;
    if (all[i].state != LinkState::Free && all[i].carries()) list(LinkId(i));
  }
}

void Links::collapse(LinkId id, const std::function<void(LinkId)>& gone) {
  const std::size_t count = all[id.index()].childCount;
  const LinkId firstChild = all[id.index()].firstChild;
  for (std::size_t i = 0; i < count; ++i) {
    const LinkId c(firstChild.index() + i);
    if (all[c.index()].childCount > 0) collapse(c, gone);
    unlist(c);
    if (gone) gone(c);
    all[c.index()] = {};
    all[c.index()].state = LinkState::Free;
  }
  if (free.size() <= count) free.resize(count + 1);
  free[count].push_back(firstChild);
  Link& l = all[id.index()];
  l.state = LinkState::Active, l.childCount = 0, l.firstChild = {};
  if (l.carries()) list(id);
}

std::size_t Links::memoryBytes() const { return all.capacity() * sizeof(Link) + arriving.capacity() * sizeof(LinkId); }

}  // namespace deltalux::hierarchy
