#include "caustics/restriction.hpp"

#include <algorithm>
#include <numeric>

namespace deltalux::caustics {

namespace {

/// The box of all marked texels that hang together with the one at (x, y), which are cleared. Neighbours may touch at
/// corners. On a closed grid the fill may run on over the seam.
TexelBox fillFrom(int x, int y, const CellGrid& grid, std::vector<char>& texels) {
  const int w = grid.width(), h = grid.height();
  TexelBox box{x, y, x + 1, y + 1};
  std::vector<glm::ivec2> open{{x, y}};
  texels[static_cast<std::size_t>(y) * w + x] = 0;
  while (!open.empty()) {
    const glm::ivec2 p = open.back();  // x not wrapped: the box is that of one unrolled patch
    open.pop_back();
    box = {std::min(box.x0, p.x), std::min(box.y0, p.y), std::max(box.x1, p.x + 1), std::max(box.y1, p.y + 1)};
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int ny = p.y + dy, nx = p.x + dx;
        if (ny < 0 || ny >= h || (!grid.closed() && (nx < 0 || nx >= w))) continue;
        char& texel = texels[static_cast<std::size_t>(ny) * w + ((nx % w + w) % w)];
        if (!texel) continue;
        texel = 0;
        open.push_back({nx, ny});
      }
  }
  return box;
}

void widen(TexelBox& box, int margin, const CellGrid& grid) {
  box.x0 -= margin, box.x1 += margin;
  box.y0 = std::max(0, box.y0 - margin), box.y1 = std::min(grid.height(), box.y1 + margin);
  if (!grid.closed()) {
    box.x0 = std::max(0, box.x0), box.x1 = std::min(grid.width(), box.x1);
  } else if (box.x1 - box.x0 >= grid.width()) {
    box.x0 = 0, box.x1 = grid.width();
  } else if (box.x0 < 0) {
    box.x0 += grid.width(), box.x1 += grid.width();
  }
}

/// How far `b` must be turned to overlap `a` or come next to it; 0 on open grids.
int nearestTurn(const TexelBox& a, const TexelBox& b, const CellGrid& grid) {
  if (!grid.closed()) return 0;
  const double turns = (0.5 * (a.x0 + a.x1) - 0.5 * (b.x0 + b.x1)) / grid.width();
  return static_cast<int>(std::lround(turns)) * grid.width();
}

bool mergeOverlapping(std::vector<TexelBox>& boxes, const CellGrid& grid) {
  for (std::size_t i = 0; i < boxes.size(); ++i)
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      TexelBox& a = boxes[i];
      TexelBox b = boxes[j];
      const int turn = nearestTurn(a, b, grid);
      b.x0 += turn, b.x1 += turn;
      if (a.x0 >= b.x1 || b.x0 >= a.x1 || a.y0 >= b.y1 || b.y0 >= a.y1) continue;
      a = {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
      widen(a, 0, grid);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(j));
      return true;
    }
  return false;
}

}  // namespace

bool holds(const TexelBox& box, int x, int y, int width) {
  return y >= box.y0 && y < box.y1 && ((x >= box.x0 && x < box.x1) || (x + width >= box.x0 && x + width < box.x1));
}

std::vector<char> cellsOffMedian(const CellGrid& grid, const std::vector<float>& E, double difference) {
  const double median = weightedMedian(E, grid.areas());
  std::vector<char> marked;
  for (const float e : E) marked.push_back(std::abs(e - median) > difference);
  return marked;
}

std::vector<TexelBox> markedBoxes(const CellGrid& grid, const std::vector<char>& marked, int margin) {
  std::vector<char> texels(static_cast<std::size_t>(grid.width()) * grid.height(), 0);
  for (std::size_t i = 0; i < texels.size(); ++i)
    texels[i] = grid.cellOf(i) != CellGrid::kNone && marked[grid.cellOf(i)];
  std::vector<TexelBox> boxes;
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x)
      if (texels[static_cast<std::size_t>(y) * grid.width() + x]) boxes.push_back(fillFrom(x, y, grid, texels));
  for (TexelBox& box : boxes) widen(box, margin, grid);
  while (mergeOverlapping(boxes, grid)) {
  }
  return boxes;
}

Region regionOf(const CellGrid& grid, const TexelBox& box) {
  const Vec2 texel = grid.region().size() / Vec2(grid.width(), grid.height());
  return {grid.region().lower + texel * Vec2(box.x0, box.y0), grid.region().lower + texel * Vec2(box.x1, box.y1)};
}

}  // namespace deltalux::caustics
