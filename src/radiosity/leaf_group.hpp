#pragma once
// Leaf patches beside each other, whose chances are drawn together: what one of them gets too much of by chance, the
// others get less. Those of one patch up to three levels above them, each at its place in it.
#include "base/random.hpp"
#include "hierarchy/element.hpp"

namespace deltalux::radiosity {

struct LeafGroup {
  static constexpr int kLevels = 3;
  static constexpr unsigned kPlaces = 1u << (2 * kLevels);

  std::uint64_t key = 0;
  unsigned place = 0;  // [0, kPlaces): the path to the leaf, two bits a level, the leaf's own in the lowest
};

inline LeafGroup groupOf(const hierarchy::Elements& elements, hierarchy::ElementId leaf) {
  hierarchy::ElementId above = leaf;
  unsigned levels = 0;
  for (; levels < LeafGroup::kLevels && elements.at(above).depth > 0; ++levels) above = elements.at(above).parent;
  const auto path = static_cast<unsigned>(elements.domain[leaf.index()].address) & ((1u << (2 * levels)) - 1);
  return {combineKeys(elements.key[above.index()], levels), path};
}

}  // namespace deltalux::radiosity
