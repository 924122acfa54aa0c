#pragma once
// Disjoint sets of numbers, each named by its least member. Cost: next to none a step, by halving the ways up.
#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace deltalux {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  /// The least member of the set of `i`.
  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t i, std::uint32_t j) {
    i = of(i), j = of(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace deltalux
