#include "caustics/cell_grid.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "caustics/tuning.hpp"

namespace deltalux::caustics {

namespace {
constexpr double kWholeTurn = 1e-9;  // of the chart's width [rounding]
}  // namespace

CellGrid::CellGrid(const Chart& chart, const Region& region, int width, int height, std::span<const float> areas)
    : chart_(chart),
      region_(region),
      perUnit_(Vec2(width, height) / region.size()),
      width_(width),
      height_(height),
      texelAreas_(areas.begin(), areas.end()) {
  DELTALUX_CHECK(areas.size() == static_cast<std::size_t>(width) * height, "one area per texel");
  closed_ = chart.closed() && region.size().x >= chart.size.x * (1 - kWholeTurn);
  const double edge = kWholeTurn * chart.size.y;
  poleAtStart_ = closed_ && chart.poleAtStart() && region.lower.y <= edge;
  poleAtEnd_ = closed_ && chart.poleAtEnd() && region.upper.y >= chart.size.y - edge;
  cellOf_.resize(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) cellOf_[i] = areas[i] > 0 ? static_cast<std::uint32_t>(i) : kNone;
  if (unrolled())
    joinTowardsPoles();
  else
    joinSlivers();
  numberCells();
}

/// Texels of a row that make one cell.
int CellGrid::groupAt(int row) const {
  if (!unrolled()) return 1;
  const Vec2 texel = texelSize();
  const double across = texel.x * chart_.stretch(region_.lower.y + (row + 0.5) * texel.y);
  int group = 1;
  while (group < width_ && 2 * group * across < texel.y) group *= 2;
  return group;
}

double CellGrid::widthOfCells(int row) const {
  const Vec2 texel = texelSize();
  return texel.x * chart_.stretch(region_.lower.y + (row + 0.5) * texel.y) * groupAt(row);
}

double CellGrid::lengthAbove(int row) const {
  const Vec2 texel = texelSize();
  return texel.x * chart_.stretch(region_.lower.y + (row + 1) * texel.y);
}

void CellGrid::joinTowardsPoles() {
  for (int y = 0; y < height_; ++y)
    for (int x = 0, group = groupAt(y); x < width_; ++x) {
      const std::size_t first = texelAt(x - x % group, y);
      if (texelAreas_[texelAt(x, y)] > 0 && texelAreas_[first] > 0)
        cellOf_[texelAt(x, y)] = static_cast<std::uint32_t>(first);
    }
}

void CellGrid::joinSlivers() {
  const std::vector<float>& areas = texelAreas_;
  const float whole = areas.empty() ? 0.0f : *std::max_element(areas.begin(), areas.end());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = texelAt(x, y);
      if (!(areas[i] > 0) || 2 * areas[i] >= whole) continue;
      std::size_t best = i;
      const auto consider = [&](int nx, int ny) {
        if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) return;
        if (areas[texelAt(nx, ny)] > areas[best]) best = texelAt(nx, ny);
      };
      consider(x - 1, y), consider(x + 1, y), consider(x, y - 1), consider(x, y + 1);
      // Only ever towards larger areas, so that no chain comes back to itself.
      cellOf_[i] = static_cast<std::uint32_t>(best);
    }
}

/// Cells in the order of the texels that the others of each were joined to.
void CellGrid::numberCells() {
  std::vector<std::uint32_t> number(cellOf_.size(), kNone);
  for (std::size_t i = 0; i < cellOf_.size(); ++i) {
    if (cellOf_[i] != i) continue;
    number[i] = static_cast<std::uint32_t>(areas_.size());
    texels_.push_back(static_cast<std::uint32_t>(i)), areas_.push_back(0.0f);
  }
  for (std::size_t i = 0; i < cellOf_.size(); ++i) {
    std::uint32_t root = cellOf_[i];
    if (root == kNone) continue;
    while (number[root] == kNone) root = cellOf_[root];
    cellOf_[i] = root;
    areas_[number[root]] += texelAreas_[i];
  }
  for (std::uint32_t& cell : cellOf_)
    if (cell != kNone) cell = number[cell];
  for (const float a : areas_) totalArea_ += a;
}

/// `at`: in texels.
std::uint32_t CellGrid::texelAround(const Vec2& at) const {
  const int x = std::clamp(static_cast<int>(at.x), 0, width_ - 1),
            y = std::clamp(static_cast<int>(at.y), 0, height_ - 1);
  for (int ring = 1; ring < std::max(width_, height_); ++ring) {
    std::uint32_t best = kNone;
    double least = kInfinity;
    for (int dy = -ring; dy <= ring; ++dy)
      for (int dx = -ring; dx <= ring; dx += std::abs(dy) == ring ? 1 : 2 * ring) {
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_ || cellOf_[texelAt(nx, ny)] == kNone) continue;
        const Vec2 d = Vec2(nx + 0.5, ny + 0.5) - at;
        if (glm::dot(d, d) < least) least = glm::dot(d, d), best = static_cast<std::uint32_t>(texelAt(nx, ny));
      }
    if (best != kNone) return best;
  }
  return kNone;
}

}  // namespace deltalux::caustics
