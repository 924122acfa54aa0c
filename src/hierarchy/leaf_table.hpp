#pragma once
// The receiving leaves of a mesh by one dense number each: what arrays over leaves are indexed by.
#include <limits>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

struct LeafTable {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  std::vector<ElementId> leaves;       // ascending
  std::vector<std::uint32_t> indexOf;  // by element; kNone: no receiving leaf

  LeafTable() = default;
  explicit LeafTable(const Elements& elements) : indexOf(elements.size(), kNone) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      if (!elements.isReceivingLeaf(ElementId(i))) continue;
      indexOf[i] = static_cast<std::uint32_t>(leaves.size());
      leaves.emplace_back(i);
    }
  }
  std::size_t size() const { return leaves.size(); }
  ElementId operator[](std::size_t i) const { return leaves[i]; }
};

}  // namespace deltalux::hierarchy
