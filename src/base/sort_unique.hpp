#pragma once
#include <algorithm>
#include <vector>

namespace deltalux {

/// Sorts in ascending order and leaves one of each.
template <class T>
void sortUnique(std::vector<T>& all) {
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

}  // namespace deltalux
