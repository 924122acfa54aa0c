#pragma once
// Links that are to be emitted again: "during motion, we keep track of all links which should be updated, but only
// re-emit a small, user-controllable percentage of them. When motion stops, we simply re-emit all particles which were
// collected during the motion, but not emitted" [GD01 4.3]. A link that waits keeps the particles that it had.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace deltalux::paper {

class LinkQueue {
 public:
  /// One that waits already stays where it is.
  void add(std::span<const std::uint32_t> links) {
    for (const std::uint32_t link : links) {
      if (link >= waits_.size()) waits_.resize(link + 1, 0);
      if (!waits_[link]) waits_[link] = 1, waiting_.push_back(link);
    }
  }

  /// Takes out the share that has waited longest, in (0, 1], rounded up. Ascending.
  std::vector<std::uint32_t> take(double share) {
    const auto all = static_cast<double>(waiting_.size());
    const std::size_t count =
        share > 0 && share < 1 ? static_cast<std::size_t>(std::ceil(share * all)) : waiting_.size();
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(count);
    std::vector<std::uint32_t> links(waiting_.begin(), end);
    waiting_.erase(waiting_.begin(), end);
    for (const std::uint32_t link : links) waits_[link] = 0;
    std::sort(links.begin(), links.end());
    return links;
  }

  std::size_t size() const { return waiting_.size(); }
  void clear() { waiting_.clear(), waits_.clear(); }

 private:
  std::vector<std::uint32_t> waiting_;  // oldest first
  std::vector<char> waits_;             // by link
};

}  // namespace deltalux::paper
