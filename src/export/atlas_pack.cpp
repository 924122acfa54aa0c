#include "export/atlas_pack.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "base/check.hpp"

namespace deltalux::exporting {

namespace {

/// The upper border of what is on a page.
class Skyline {
 public:
  explicit Skyline(int side) : side_(side), steps_{{0, 0}} {}

  /// Where a rectangle would lie; nullopt: nowhere.
  std::optional<glm::ivec2> find(const glm::ivec2& size) const {
    std::optional<glm::ivec2> best;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const int x = steps_[i].x;
      if (x + size.x > side_) break;
      int y = 0;
      for (std::size_t j = i; j < steps_.size() && steps_[j].x < x + size.x; ++j) y = std::max(y, steps_[j].y);
      if (y + size.y <= side_ && (!best || y < best->y)) best = glm::ivec2(x, y);
    }
    return best;
  }

  void put(const glm::ivec2& corner, const glm::ivec2& size) {
    const int end = corner.x + size.x;
    std::vector<glm::ivec2> steps;
    int after = 0;  // the height where the rectangle ends
    for (const glm::ivec2& s : steps_)
      if (s.x < corner.x) steps.push_back(s);
    for (const glm::ivec2& s : steps_)
      if (s.x <= end) after = s.y;
    steps.emplace_back(corner.x, corner.y + size.y);
    if (end < side_) steps.emplace_back(end, after);
    for (const glm::ivec2& s : steps_)
      if (s.x > end) steps.push_back(s);
    steps_ = std::move(steps);
    used_ = glm::max(used_, corner + size);
  }

  const glm::ivec2& used() const { return used_; }

 private:
  int side_;
  std::vector<glm::ivec2> steps_;  // where a height begins, and the height
  glm::ivec2 used_{0};
};

}  // namespace

Packing packRects(std::span<const glm::ivec2> sizes, int side) {
  std::vector<std::uint32_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return sizes[a].y != sizes[b].y ? sizes[a].y > sizes[b].y : sizes[a].x > sizes[b].x;
  });
  Packing packing;
  packing.at.resize(sizes.size());
  std::vector<Skyline> pages;
  for (const std::uint32_t i : order) {
    DELTALUX_CHECK(sizes[i].x > 0 && sizes[i].y > 0 && sizes[i].x <= side && sizes[i].y <= side, "it fits a page");
    std::optional<glm::ivec2> corner;
    std::size_t page = 0;
    for (; page < pages.size() && !corner; ++page) corner = pages[page].find(sizes[i]);
    if (corner) {
      --page;
    } else {
      pages.emplace_back(side);
      corner = pages.back().find(sizes[i]);
    }
    pages[page].put(*corner, sizes[i]);
    packing.at[i] = {static_cast<std::uint32_t>(page), *corner};
  }
  for (const Skyline& page : pages) packing.pages.push_back(page.used());
  return packing;
}

}  // namespace deltalux::exporting
