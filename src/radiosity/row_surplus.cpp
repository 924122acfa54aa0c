#include "radiosity/row_surplus.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/paged_array.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/most_returned.hpp"

namespace deltalux::radiosity {

namespace {

constexpr float kSameGroup = 1e-3f;  // relative difference of what a group takes that is none
constexpr int kHighest = 9;          // levels of a group above the furthest of its leaves

bool alike(float a, float b) { return std::abs(a - b) <= kSameGroup * std::max(a, b); }

}  // namespace

void RowSurplus::resize(const hierarchy::Elements& elements) { resizeWithRoom(nodes_, elements.size()); }

void RowSurplus::takeLeaf(const hierarchy::Elements& elements, std::size_t e) {
  Node& node = nodes_[e];
  const hierarchy::ElementGeometry& g = elements.geometry[e];
  const float limit = std::max(1.0f, hierarchy::mostReturned(elements.radiometry[e]));
  node.scale = 1 / std::max(g.exposed, node.factors / limit);
  node.surplus = g.area * std::max(0.0f, node.factors - limit * g.exposed);
  node.room = g.area * std::clamp(g.exposed - node.factors, 0.0f, node.factors);
  node.height = 0;
}

/// Whether its group, if it is one, is another than before.
bool RowSurplus::takeParts(const hierarchy::Elements& elements, std::size_t e) {
  Node& node = nodes_[e];
  float surplus = 0, room = 0;
  int height = 0;
  for (std::size_t i = 0; i < elements.topology[e].childCount; ++i) {
    const Node& part = nodes_[elements.child(hierarchy::ElementId(e), i).index()];
    surplus += part.surplus, room += part.room;
    height = std::max(height, part.height + 1);
  }
  const Node before = node;
  const bool holds = surplus > 0 && room >= surplus && height <= kHighest;
  node.height = static_cast<std::uint8_t>(std::min(height, kHighest + 1));  // higher ones are all alike
  node.taken = holds ? surplus / room : 0.0f;
  node.perRoom = holds ? 1 / room : 0.0f;
  node.surplus = holds ? 0.0f : surplus;
  node.room = holds ? room - surplus : room;
  if (holds && node.slot == kNone) {
    node.slot = static_cast<std::uint32_t>(groups_.size());
    if (!free_.empty()) node.slot = free_.back(), free_.pop_back();
    if (node.slot == groups_.size()) groups_.emplace_back();
    groups_[node.slot] = hierarchy::ElementId(e);
  } else if (!holds && node.slot != kNone) {
    groups_[node.slot] = {};
    free_.push_back(std::exchange(node.slot, kNone));
  }
  return !alike(node.taken, before.taken) || !alike(node.perRoom, before.perRoom);
}

void RowSurplus::follow(const hierarchy::Elements& elements, std::span<const hierarchy::ElementId> leaves,
                        std::vector<hierarchy::ElementId>& concerned) {
  PagedArray<char> marked(elements.size());
  for (hierarchy::ElementId e : leaves)
    for (; e.valid() && !marked[e.index()]; e = elements.at(e).parent) marked.at(e.index()) = 1;
  std::vector<hierarchy::ElementId> upwards, full, groups;
  marked.forEach([&](std::size_t e, char) { upwards.emplace_back(e); });
  std::reverse(upwards.begin(), upwards.end());
  for (const hierarchy::ElementId e : upwards) {
    if (elements.isReceivingLeaf(e)) {
      takeLeaf(elements, e.index());
      if (nodes_[e.index()].surplus > 0) full.push_back(e);
    } else if (takeParts(elements, e.index())) {
      groups.push_back(e);
    }
  }
  std::erase_if(full_, [&](hierarchy::ElementId e) { return bool(marked[e.index()]); });
  const auto known = static_cast<std::ptrdiff_t>(full_.size());
  full_.insert(full_.end(), full.rbegin(), full.rend());
  std::inplace_merge(full_.begin(), full_.begin() + known, full_.end());
  for (const hierarchy::ElementId group : groups) addWithRoom(elements, group, concerned);
}

void RowSurplus::addWithRoom(const hierarchy::Elements& elements, hierarchy::ElementId group,
                             std::vector<hierarchy::ElementId>& leaves) const {
  hierarchy::forEachLeafBelow(elements, group, [&](hierarchy::ElementId leaf) {
    if (nodes_[leaf.index()].room > 0) leaves.push_back(leaf);
  });
}

RowSurplus::Pools RowSurplus::pools(const hierarchy::Elements& elements) const {
  struct Beyond {
    std::uint32_t slot = kNone;  // none where there is no room anywhere
    RgbSum light{0.0};
  };
  std::vector<Beyond> beyond(full_.size());
  parallelFor(full_.size(), 1024, [&](std::size_t i) {
    const hierarchy::ElementId leaf = full_[i];
    hierarchy::ElementId above = elements.at(leaf).parent;
    while (above.valid() && nodes_[above.index()].slot == kNone) above = elements.at(above).parent;
    if (!above.valid()) return;
    const hierarchy::ElementGeometry& g = elements.shape(leaf);
    const double area = double(g.area) * (1.0 / double(scale(leaf)) - double(g.exposed));
    beyond[i] = {nodes_[above.index()].slot, area * RgbSum(elements.radiometry[leaf.index()].indirect)};
  });
  std::vector<RgbSum> light(groups_.size(), RgbSum(0.0));
  for (const Beyond& b : beyond)
    if (b.slot != kNone) light[b.slot] += b.light;
  Pools pools(groups_.size(), Rgb(0.0f));
  for (std::size_t i = 0; i < pools.size(); ++i)
    if (groups_[i].valid()) pools[i] = Rgb(double(nodes_[groups_[i].index()].perRoom) * light[i]);
  return pools;
}

Rgb RowSurplus::share(const hierarchy::Elements& elements, hierarchy::ElementId leaf, const Pools& pools) const {
  Rgb sum(0.0f);
  const Node& own = nodes_[leaf.index()];
  if (!(own.room > 0)) return sum;
  float left = 1;  // of the leaf's room
  for (hierarchy::ElementId e = elements.at(leaf).parent; e.valid() && left > 0; e = elements.at(e).parent) {
    const Node& node = nodes_[e.index()];
    if (node.slot == kNone) continue;
    sum += left * pools[node.slot];
    left *= 1 - node.taken;
  }
  return own.room / elements.shape(leaf).litArea() * sum;
}

void RowSurplus::listen(const hierarchy::Elements& elements, const Pools& now, float same, Pools& heard,
                        std::vector<hierarchy::ElementId>& leaves) const {
  heard.resize(now.size(), Rgb(0.0f));
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (maxChannel(glm::abs(now[i] - heard[i])) <= same * maxChannel(now[i])) continue;
    heard[i] = now[i];
    if (groups_[i].valid()) addWithRoom(elements, groups_[i], leaves);
  }
}

std::size_t RowSurplus::memoryBytes() const {
  return nodes_.capacity() * sizeof(Node) + (groups_.capacity() + full_.capacity()) * sizeof(hierarchy::ElementId) +
         free_.capacity() * sizeof(std::uint32_t);
}

void RowSurplus::validate(const hierarchy::Elements& elements) const {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
  };
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (node.slot != kNone)
      require(node.slot < groups_.size() && groups_[node.slot] == hierarchy::ElementId(i) && node.height <= kHighest,
              "row surplus: groups and their slots");
    require((node.taken > 0) == (node.slot != kNone) && node.taken <= 1, "row surplus: a group takes what there is");
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    require(std::isfinite(node.scale) && node.scale > 0, "row surplus: scale");
    require((node.surplus > 0) == std::binary_search(full_.begin(), full_.end(), hierarchy::ElementId(i)),
            "row surplus: leaves that have some are listed");
  }
}

}  // namespace deltalux::radiosity
