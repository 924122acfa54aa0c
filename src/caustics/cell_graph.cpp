#include "caustics/cell_graph.hpp"

#include <algorithm>
#include <utility>

namespace deltalux {

CellGraph::CellGraph(std::vector<float> areas, std::vector<glm::ivec2> places,
                     std::span<const std::uint32_t> firstBorder, std::span<const Border> borders)
    : area_(std::move(areas)), place_(std::move(places)), share_(borders.size()), open_(borders.size()) {
  for (const float a : area_) totalArea_ += a;
  const auto distance = [&](std::size_t cell, std::size_t k) {
    return static_cast<std::int32_t>(std::int64_t(borders[firstBorder[cell] + k].cell) - std::int64_t(cell));
  };
  const auto alike = [&](std::size_t a, std::size_t b) {
    const std::size_t count = firstBorder[a + 1] - firstBorder[a];
    if (firstBorder[b + 1] - firstBorder[b] != count || count > kMostNeighbours) return false;
    for (std::size_t k = 0; k < count; ++k)
      if (distance(a, k) != distance(b, k) ||
          borders[firstBorder[a] + k].diagonal != borders[firstBorder[b] + k].diagonal)
        return false;
    return true;
  };
  std::uint32_t next = 0;  // border
  for (std::size_t first = 0, end = 0; first < size(); first = end) {
    for (end = first + 1; end < size() && alike(first, end);) ++end;
    const std::size_t all = firstBorder[first + 1] - firstBorder[first];
    std::size_t done = 0;
    do {
      Run run{static_cast<std::uint32_t>(first),
              static_cast<std::uint32_t>(end - first),
              next,
              static_cast<std::uint32_t>(std::min(kMostNeighbours, all - done)),
              {},
              {}};
      for (std::size_t k = 0; k < run.neighbours; ++k) {
        run.offset[k] = distance(first, done + k);
        run.diagonal[k] = borders[firstBorder[first] + done + k].diagonal;
        for (std::size_t i = first; i < end; ++i, ++next) {
          const Border& b = borders[firstBorder[i] + done + k];
          share_[next] = b.share, open_[next] = b.open;
        }
      }
      runs_.push_back(run);
      done += kMostNeighbours;
    } while (done < all);
  }
}

}  // namespace deltalux
