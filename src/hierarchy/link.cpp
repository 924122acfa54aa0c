#include "hierarchy/link.hpp"

namespace deltalux::hierarchy {

LinkId Links::addRoot(ElementId receiver, ElementId sender) {
  const LinkId id(all.size());
  all.emplace_back();
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
  }
  Link& above = all[parent.index()];
  above.state = LinkState::Interior;
  above.firstChild = firstChild;
  above.childCount = static_cast<std::uint16_t>(count);
  return firstChild;
}

void Links::setEnds(LinkId id, ElementId receiver, ElementId sender) {
  all[id.index()].receiver = receiver, all[id.index()].sender = sender;
}

void Links::evaluated(LinkId id, const Link& as) {
  Link& l = all[id.index()];
  l.K = as.K, l.V = as.V;
  l.receiverSpread = as.receiverSpread, l.senderSpread = as.senderSpread, l.visibilitySpread = as.visibilitySpread;
  l.sampleMask = as.sampleMask, l.samples = as.samples, l.visibility = as.visibility;
  if (l.state != LinkState::Interior) l.state = as.state;
}

void Links::collapse(LinkId id) {
  const std::size_t count = all[id.index()].childCount;
  const LinkId firstChild = all[id.index()].firstChild;
  for (std::size_t i = 0; i < count; ++i) {
    const LinkId c(firstChild.index() + i);
    if (all[c.index()].childCount > 0) collapse(c);
    all[c.index()] = {};
    all[c.index()].state = LinkState::Free;
  }
  if (free.size() <= count) free.resize(count + 1);
  free[count].push_back(firstChild);
  Link& l = all[id.index()];
  l.state = LinkState::Active, l.childCount = 0, l.firstChild = {};
}

}  // namespace deltalux::hierarchy
