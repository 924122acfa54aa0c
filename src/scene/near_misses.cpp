#include <algorithm>
#include <deltalux/scene.hpp>
#include <numeric>
#include <utility>

#include "base/sort_unique.hpp"

namespace deltalux {

namespace {

/// Levenshtein distance [Levenshtein66], by rows.
std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> nearMisses(std::string_view name, const std::vector<std::string>& existing,
                                    std::size_t count) {
  std::vector<std::pair<std::size_t, std::string_view>> ranked;
  for (const std::string& candidate : existing) ranked.emplace_back(editDistance(name, candidate), candidate);
  sortUnique(ranked);
  std::vector<std::string> nearest;
  for (std::size_t i = 0; i < std::min(count, ranked.size()); ++i) nearest.emplace_back(ranked[i].second);
  return nearest;
}

}  // namespace deltalux
