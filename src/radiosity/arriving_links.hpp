#pragma once
// What a move has done to the links that arrive at a leaf or above it: whether any was touched, and which have changed;
// of links from lights and of those from surfaces apart.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "radiosity/line_space.hpp"

namespace deltalux {

class ArrivingLinks {
 public:
  /// `changed`: the topmost changed links. All must outlive this.
  ArrivingLinks(const Elements& elements, const Links& links, const LinkMarks& marks, std::span<const LinkId> changed)
      : elements_(elements), flags_(elements.size(), 0) {
    for (const LinkId id : marks.touched)
      if (links[id].state != LinkState::Free) add(links[id].receiver, kTouched, elements.at(links[id].sender).emitter);
    for (const LinkId id : changed) {
      const bool ofLights = elements.at(links[id].sender).emitter;
      add(links[id].receiver, kChanged | kOwn, ofLights);
      changed_[ofLights].push_back({links[id].receiver, id});
    }
    for (auto& list : changed_) std::sort(list.begin(), list.end());
    for (std::size_t e = 0; e < flags_.size(); ++e)  // parents stand before their children
      if (const ElementId up = elements.topology[e].parent; up.valid())
        add(ElementId(e), flags_[up.index()] & kInherited, false);
  }

  bool touched(ElementId leaf, bool ofLights) const { return flags_[leaf.index()] & kTouched << ofLights; }
  bool changed(ElementId leaf, bool ofLights) const { return flags_[leaf.index()] & kChanged << ofLights; }

  /// The changed links, from the leaf upwards.
  std::vector<LinkId> changedAt(ElementId leaf, bool ofLights) const {
    std::vector<LinkId> out;
    const auto& list = changed_[ofLights];
    for (ElementId e = leaf; e.valid() && changed(e, ofLights); e = elements_.at(e).parent) {
      if (!(flags_[e.index()] & kOwn << ofLights)) continue;
      auto it = std::lower_bound(list.begin(), list.end(), std::pair(e, LinkId(0u)));
      for (; it != list.end() && it->first == e; ++it) out.push_back(it->second);
    }
    return out;
  }

 private:
  // Shifted by one for links from lights.
  static constexpr int kTouched = 1, kChanged = 4, kOwn = 16, kInherited = 15;

  void add(ElementId e, int flags, bool ofLights) {
    flags_[e.index()] = static_cast<std::uint8_t>(flags_[e.index()] | flags << ofLights);
  }

  const Elements& elements_;
  std::vector<std::uint8_t> flags_;                                   // by element: of itself and of what is above it
  std::array<std::vector<std::pair<ElementId, LinkId>>, 2> changed_;  // by receiver
};

}  // namespace deltalux
