#pragma once
// Which links that a move has changed arrive at a leaf or above it; of links from lights and of those from surfaces
// apart.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "hierarchy/below.hpp"
#include "paper/line_space.hpp"

namespace deltalux::radiosity {

class ArrivingLinks {
 public:
  /// `changed`: the topmost changed links. Elements must outlive this.
  ArrivingLinks(const hierarchy::Elements& elements, const hierarchy::Links& links,
                std::span<const hierarchy::LinkId> changed)
      : elements_(elements), flags_(elements.size()) {
    for (const hierarchy::LinkId id : changed) {
      const bool ofLights = elements.at(links[id].sender).emitter;
      changed_[ofLights].push_back({links[id].receiver, id});
      markBelow(links[id].receiver, ofLights);
      add(links[id].receiver, kOwn, ofLights);
    }
    for (auto& list : changed_) std::sort(list.begin(), list.end());
  }

  /// visit(element, whether from lights, whether from surfaces) of all at which some arrive, or above which.
  template <class Visit>
  void forEach(const Visit& visit) const {
    flags_.forEach(
        [&](std::size_t e, char flags) { visit(hierarchy::ElementId(e), flags & kBelow << 1, flags & kBelow); });
  }

  /// From the leaf upwards.
  std::vector<hierarchy::LinkId> changedAt(hierarchy::ElementId leaf, bool ofLights) const {
    std::vector<hierarchy::LinkId> out;
    const auto& list = changed_[ofLights];
    for (hierarchy::ElementId e = leaf; e.valid() && flags_[e.index()] & kBelow << ofLights;
         e = elements_.at(e).parent) {
      if (!(flags_[e.index()] & kOwn << ofLights)) continue;
      auto it = std::lower_bound(list.begin(), list.end(), std::pair(e, hierarchy::LinkId(0u)));
      for (; it != list.end() && it->first == e; ++it) out.push_back(it->second);
    }
    return out;
  }

 private:
  // Shifted by one for links from lights.
  static constexpr int kBelow = 1, kOwn = 4;

  void add(hierarchy::ElementId e, int flag, bool ofLights) {
    char& flags = flags_.at(e.index());
    flags = static_cast<char>(flags | flag << ofLights);
  }

  /// What is marked has all below it marked.
  void markBelow(hierarchy::ElementId top, bool ofLights) {
    hierarchy::forEachBelow(elements_, top, [&](hierarchy::ElementId e) {
      if (flags_[e.index()] & kBelow << ofLights) return false;
      add(e, kBelow, ofLights);
      return true;
    });
  }

  const hierarchy::Elements& elements_;
  PagedArray<char> flags_;                                                                  // by element
  std::array<std::vector<std::pair<hierarchy::ElementId, hierarchy::LinkId>>, 2> changed_;  // by receiver
};

}  // namespace deltalux::radiosity
