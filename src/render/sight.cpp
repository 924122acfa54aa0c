#include "render/sight.hpp"

#include <algorithm>

#include "render/tuning.hpp"

namespace deltalux::rendering {

/// Alike for all leaves of it.
std::uint64_t Sights::sideOf(hierarchy::ElementId leaf) const {
  return 2 * std::uint64_t(elements_.domain[leaf.index()].primitive.value) + (elements_.at(leaf).front ? 1 : 0);
}

void Sights::learn(int raysOfPlace, int rays, std::uint64_t key) {
  std::vector<Place> places;
  places.swap(places_);
  if (places.empty()) return;
  std::stable_sort(places.begin(), places.end(), [&](const Place& a, const Place& b) {
    return std::pair(sideOf(a.leaf), a.leaf) < std::pair(sideOf(b.leaf), b.leaf);
  });
  std::vector<direct::Receiver> receivers;
  std::vector<std::size_t> first;  // place of each leaf, and of the end
  std::vector<std::vector<direct::Source>> sources;
  for (std::size_t i = 0; i < places.size(); ++i) {
    receivers.push_back(places[i].at);
    if (i > 0 && places[i].leaf == places[i - 1].leaf) continue;
    first.push_back(i), sources.push_back(sources_.at(places[i].leaf));
  }
  first.push_back(places.size());
  const int shared =
      std::max(direct::kLearnAtPoint, raysOfPlace * static_cast<int>(places.size()) / tuning::kLearningShare);
  around_ = direct::Aim(direct::joined(sources));
  around_.learn(sources_.light(), receivers, shared, key);
  for (std::size_t begin = 0, end = 0; begin < sources.size(); begin = end) {
    const std::uint64_t side = sideOf(places[first[begin]].leaf);
    for (end = begin + 1; end < sources.size() && sideOf(places[first[end]].leaf) == side;) ++end;
    const auto own = std::span(receivers).subspan(first[begin], first[end] - first[begin]);
    direct::Aim all = around_.of(direct::joined(std::span(sources).subspan(begin, end - begin)));
    all.learn(sources_.light(), own, raysOfPlace * static_cast<int>(own.size()), combineKeys(key, side));
    for (std::size_t i = begin; i < end; ++i) {
      const hierarchy::ElementId leaf = places[first[i]].leaf;
      aims_.emplace(leaf, all.at(sources[i], sources_.lightAt(leaf), rays));
    }
  }
}

/// Of a leaf where no place was noted: as what is around it has it.
const direct::Aim& Sights::aimAt(hierarchy::ElementId leaf, int rays) {
  if (const auto found = aims_.find(leaf); found != aims_.end()) return found->second;
  const std::vector<direct::Source> sources = sources_.at(leaf);
  direct::Aim aim = around_.of(sources);
  // Too little of what shines there may be known from around.
  aim = aim.holds(sources) ? aim.at(sources, sources_.lightAt(leaf), rays) : sources_.aimAt(leaf, rays);
  return aims_.emplace(leaf, std::move(aim)).first->second;
}

}  // namespace deltalux::rendering
