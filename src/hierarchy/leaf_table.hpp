#pragma once
// The receiving leaves of a mesh by one dense number each: what arrays over leaves are indexed by. Their order is that
// of surfaces and of the quadtrees below, wherever elements are stored: equal meshes number their leaves alike, so that
// sums over them are the same to the last bit.
#include <limits>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

struct LeafTable {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::vector<ElementId> leaves;       // in order
  std::vector<std::uint32_t> indexOf;  // by element; kNone: no receiving leaf

  LeafTable() = default;
  explicit LeafTable(const Elements& elements) : indexOf(elements.size(), kNone) {
    std::vector<ElementId> stack;
    for (std::size_t input = 0; input < elements.size(); ++input) {
      if (!elements.isInputLevel(ElementId(input)) || !elements.receives(ElementId(input))) continue;
      stack.emplace_back(input);
      while (!stack.empty()) {
        const ElementId e = stack.back();
        stack.pop_back();
        for (std::size_t i = elements.at(e).childCount; i-- > 0;) stack.push_back(elements.child(e, i));
        if (!elements.isLeaf(e)) continue;
        indexOf[e.index()] = static_cast<std::uint32_t>(leaves.size());
        leaves.push_back(e);
      }
    }
  }
  std::size_t size() const { return leaves.size(); }
  ElementId operator[](std::size_t i) const { return leaves[i]; }
};

}  // namespace deltalux::hierarchy
