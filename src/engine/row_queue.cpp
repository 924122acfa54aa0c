#include "engine/row_queue.hpp"

#include <algorithm>
#include <utility>

namespace deltalux::engine {

void RowQueue::add(RowWork more, const radiosity::LeafTransfers& transfers, const hierarchy::Elements& elements,
                   const hierarchy::Links& links, double stale) {
  stale_ = this->stale() + stale;
  std::vector<char> urgent(elements.size(), 1);
  for (const radiosity::LeafRow& row : transfers.rows()) urgent[row.leaf.index()] = more.space.moved(row.leaf);
  const radiosity::ConcernedLeaves leaves = std::exchange(more.leaves, {});
  ++moves_;
  addWork(std::move(more), links);
  add(leaves, urgent, elements);
}

void RowQueue::addWork(RowWork more, const hierarchy::Links& links) {
  if (moves_ == 1) {
    work_ = std::move(more);
    return;
  }
  // Links beyond those that a move knew are new to it.
  paper::LinkChanges &to = work_.marks.changes, &from = more.marks.changes;
  const std::size_t known = to.size();
  to.grow(links.size());
  for (std::size_t i = known; i < links.size(); ++i) to.at(i) = paper::LinkChange::Changed;
  from.forEach([&](std::size_t i, paper::LinkChange change) { to.at(i) = std::max(to[i], change); });
  work_.space.add(more.space);
  std::vector<char> listed(links.size(), 0);
  work_.changed.insert(work_.changed.end(), more.changed.begin(), more.changed.end());
  std::erase_if(work_.changed, [&](hierarchy::LinkId id) {
    return links[id].state == hierarchy::LinkState::Free || std::exchange(listed[id.index()], 1);
  });
  std::erase_if(work_.changed, [&](hierarchy::LinkId id) {
    for (hierarchy::LinkId up = links[id].parent; up.valid(); up = links[up].parent)
      if (listed[up.index()]) return true;
    return false;
  });
}

void RowQueue::add(const radiosity::ConcernedLeaves& leaves, const std::vector<char>& urgent,
                   const hierarchy::Elements& elements) {
  std::vector<std::uint32_t> at(elements.size(), Id<void>::kNone);  // in waiting_
  for (std::uint32_t i = 0; i < waiting_.size(); ++i) at[waiting_[i].leaf.index()] = i;
  urgent_ = {};
  const auto put = [&](const std::vector<hierarchy::ElementId>& of, std::vector<hierarchy::ElementId>& now,
                       bool Waiting::*by) {
    for (const hierarchy::ElementId leaf : of) {
      if (urgent[leaf.index()]) {
        now.push_back(leaf);
        continue;
      }
      std::uint32_t& i = at[leaf.index()];
      if (i == Id<void>::kNone) {
        i = static_cast<std::uint32_t>(waiting_.size());
        const hierarchy::ElementLight& l = elements.radiometry[leaf.index()];
        const hierarchy::ElementGeometry& g = elements.shape(leaf);
        const double near = work_.space.nearness(g.center, g.radius);
        waiting_.push_back({leaf, false, false, near * g.litArea() * gray(l.direct + l.indirect)});
      }
      waiting_[i].*by = true;
    }
  };
  put(leaves.byLights, urgent_.byLights, &Waiting::byLights);
  put(leaves.byLeaves, urgent_.byLeaves, &Waiting::byLeaves);
  std::erase_if(waiting_, [&](const Waiting& w) { return urgent[w.leaf.index()]; });
  std::sort(waiting_.begin(), waiting_.end(), [](const Waiting& a, const Waiting& b) {
    return a.light != b.light ? a.light < b.light : b.leaf < a.leaf;
  });
  light_ = 0;
  for (const Waiting& w : waiting_) light_ += w.light;
  waitingLight_ = light_;
}

radiosity::ConcernedLeaves RowQueue::take(std::size_t count, const hierarchy::Elements& elements) {
  radiosity::ConcernedLeaves taken;
  for (; count > 0 && !waiting_.empty(); --count) {
    const Waiting w = waiting_.back();
    waiting_.pop_back();
    waitingLight_ -= w.light;
    if (!elements.isReceivingLeaf(w.leaf)) continue;
    if (w.byLights) taken.byLights.push_back(w.leaf);
    if (w.byLeaves) taken.byLeaves.push_back(w.leaf);
  }
  if (waiting_.empty()) waitingLight_ = 0;
  std::sort(taken.byLights.begin(), taken.byLights.end());
  std::sort(taken.byLeaves.begin(), taken.byLeaves.end());
  return taken;
}

}  // namespace deltalux::engine
