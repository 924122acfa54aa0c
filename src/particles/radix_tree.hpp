#pragma once
// A binary tree over things that have a code of 128 bits: a node for every prefix at which codes part. What a node is
// depends on the codes below it alone, so adding a thing touches one path of nodes, and moving one touches none: the
// links of particles, and with them the particles, keep their names through every edit.
// Rejected: a tree by position, which a move rebuilds.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace deltalux::particles {

/// Compared word by word, the first counts most.
using Code = std::array<std::uint32_t, 4>;

struct RadixNode {
  std::uint32_t begin = 0, end = 0;         // of the leaves below
  std::uint32_t child[2] = {kNone, kNone};  // nodes
  std::uint64_t key = 0;

  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]
  bool isLeaf() const { return child[0] == kNone; }
};

/// Appends the tree over `codes` (ascending, all different, not empty), whose leaves are numbered from `firstLeaf`.
/// Parents stand before their children; returns the root. `seed` tells trees apart whose codes may agree.
std::uint32_t appendRadixTree(std::vector<RadixNode>&, std::span<const Code> codes, std::uint32_t firstLeaf,
                              std::uint64_t seed);

}  // namespace deltalux::particles
