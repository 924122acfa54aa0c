#include "hierarchy/link.hpp"

namespace deltalux {

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
  addArriving(id);
}

void Links::addArriving(LinkId id) {
  Link& l = all[id.index()];
  if (l.receiver.index() >= arriving.size()) arriving.resize(l.receiver.index() + 1);
  LinkId& head = arriving[l.receiver.index()];
  l.nextArriving = head, l.previousArriving = {};
  if (head.valid()) all[head.index()].previousArriving = id;
  head = id;
}

void Links::listArriving() {
  arriving.clear();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].state != LinkState::Free) addArriving(LinkId(i));
}

void Links::removeArriving(LinkId id) {
  const Link& l = all[id.index()];
  if (l.nextArriving.valid()) all[l.nextArriving.index()].previousArriving = l.previousArriving;
  LinkId& before =
      l.previousArriving.valid() ? all[l.previousArriving.index()].nextArriving : arriving[l.receiver.index()];
  before = l.nextArriving;
}

void Links::collapse(LinkId id, const std::function<void(LinkId)>& gone) {
  const std::size_t count = all[id.index()].childCount;
  const LinkId firstChild = all[id.index()].firstChild;
  for (std::size_t i = 0; i < count; ++i) {
    const LinkId c(firstChild.index() + i);
    if (all[c.index()].childCount > 0) collapse(c, gone);
    removeArriving(c);
    if (gone) gone(c);
    all[c.index()] = {};
    all[c.index()].state = LinkState::Free;
  }
  if (free.size() <= count) free.resize(count + 1);
  free[count].push_back(firstChild);
  Link& l = all[id.index()];
  l.state = LinkState::Active, l.childCount = 0, l.firstChild = {};
}

std::size_t Links::memoryBytes() const { return all.capacity() * sizeof(Link) + arriving.capacity() * sizeof(LinkId); }

}  // namespace deltalux
