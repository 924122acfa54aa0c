#include "caustics/cell_grid.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace deltalux {

namespace {
constexpr float kSliver = 0.4f;      // of a texel: less surface joins a neighbour
constexpr double kThin = 0.5;        // width over height from which texels stand alone
constexpr double kWholeTurn = 1e-9;  // of the chart's width
}  // namespace

/// Area and first texel of each.
struct CellGrid::Cells {
  std::vector<float> areas;
  std::vector<glm::ivec2> places;
};

CellGrid::CellGrid(const Chart& chart, const Region& region, int width, int height, std::span<const float> areas)
    : region_(region), width_(width), height_(height) {
  DELTALUX_CHECK(areas.size() == static_cast<std::size_t>(width) * height, "one area per texel");
  closed_ = chart.closed() && region.size().x >= chart.size.x * (1 - kWholeTurn);
  const double edge = kWholeTurn * chart.size.y;
  poleAtStart_ = closed_ && chart.poleAtStart() && region.lower.y <= edge;
  poleAtEnd_ = closed_ && chart.poleAtEnd() && region.upper.y >= chart.size.y - edge;
  cellOf_.resize(areas.size());
  for (std::size_t i = 0; i < areas.size(); ++i) cellOf_[i] = areas[i] > 0 ? static_cast<std::uint32_t>(i) : kNone;
  if (chart.closed())
    joinTowardsPoles(chart, areas);
  else
    joinSlivers(areas);
  CellGraph::operator=(findBorders(chart, areas, numberCells(areas)));
}

/// Texels of a row that make one cell.
int CellGrid::groupAt(const Chart& chart, int row) const {
  if (!chart.closed()) return 1;
  const Vec2 texel = region_.size() / Vec2(width_, height_);
  const double across = texel.x * chart.stretch(region_.lower.y + (row + 0.5) * texel.y);
  int group = 1;
  while (group < width_ && group * across < kThin * texel.y) group *= 2;
  return group;
}

void CellGrid::joinTowardsPoles(const Chart& chart, std::span<const float> areas) {
  for (int y = 0; y < height_; ++y)
    for (int x = 0, group = groupAt(chart, y); x < width_; ++x) {
      const std::size_t first = texelAt(x - x % group, y);
      if (areas[texelAt(x, y)] > 0 && areas[first] > 0) cellOf_[texelAt(x, y)] = static_cast<std::uint32_t>(first);
    }
}

void CellGrid::joinSlivers(std::span<const float> areas) {
  const float whole = areas.empty() ? 0.0f : *std::max_element(areas.begin(), areas.end());
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = texelAt(x, y);
      if (!(areas[i] > 0) || areas[i] >= kSliver * whole) continue;
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

CellGrid::Cells CellGrid::numberCells(std::span<const float> areas) {
  const auto rootOf = [&](std::uint32_t i) {
    while (cellOf_[i] != i) i = cellOf_[i];
    return i;
  };
  std::vector<std::uint32_t> root(cellOf_.size(), kNone), number(cellOf_.size(), kNone);
  for (std::size_t i = 0; i < cellOf_.size(); ++i)
    if (cellOf_[i] != kNone) root[i] = rootOf(static_cast<std::uint32_t>(i));
  Cells cells;
  for (std::size_t i = 0; i < root.size(); ++i) {
    if (root[i] == kNone) continue;
    std::uint32_t& n = number[root[i]];
    if (n == kNone) {
      n = static_cast<std::uint32_t>(cells.areas.size());
      cells.areas.push_back(0.0f);
      cells.places.emplace_back(static_cast<int>(i) % width_, static_cast<int>(i) / width_);
    }
    cellOf_[i] = n;
    cells.areas[n] += areas[i];
  }
  return cells;
}

/// What texels share with the one to the right, above, above to the right, and above to the left.
struct CellGrid::Shares {
  std::vector<float> right, above, aboveRight, aboveLeft;
};

namespace {

/// One border for each of the cells, ascending.
void addMerged(std::vector<CellGraph::Border>& found, std::vector<CellGraph::Border>& borders) {
  const auto earlier = [](const auto& a, const auto& b) { return a.cell < b.cell; };
  if (!std::is_sorted(found.begin(), found.end(), earlier)) std::stable_sort(found.begin(), found.end(), earlier);
  const std::size_t first = borders.size();
  for (const CellGraph::Border& b : found)
    if (borders.size() > first && borders.back().cell == b.cell)
      borders.back().share += b.share;
    else
      borders.push_back(b);
}

}  // namespace

CellGraph CellGrid::findBorders(const Chart& chart, std::span<const float> areas, Cells cells) const {
  Shares shares;
  for (auto* s : {&shares.right, &shares.above, &shares.aboveRight, &shares.aboveLeft}) s->assign(areas.size(), 0.0f);
  shareSides(chart, areas, shares);
  shareDiagonals(chart, areas, cells, shares);

  // The texels of each cell.
  std::vector<std::uint32_t> first(cells.areas.size() + 1, 0), texels(areas.size());
  for (const std::uint32_t cell : cellOf_)
    if (cell != kNone) ++first[cell + 1];
  for (std::size_t c = 0; c + 1 < first.size(); ++c) first[c + 1] += first[c];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t i = 0; i < cellOf_.size(); ++i)
    if (cellOf_[i] != kNone) texels[next[cellOf_[i]]++] = i;

  std::vector<Border> borders, found;
  borders.reserve(kMostNeighbours * cells.areas.size());
  std::vector<std::uint32_t> firstBorder(1, 0);
  for (std::size_t c = 0; c + 1 < first.size(); ++c) {
    found.clear();
    for (std::uint32_t k = first[c]; k < first[c + 1]; ++k) addNeighbours(texels[k], shares, found);
    addMerged(found, borders);
    firstBorder.push_back(static_cast<std::uint32_t>(borders.size()));
  }
  return CellGraph(std::move(cells.areas), std::move(cells.places), firstBorder, borders);
}

void CellGrid::shareSides(const Chart& chart, std::span<const float> areas, Shares& shares) const {
  const Vec2 texel = region_.size() / Vec2(width_, height_);
  const float whole = areas.empty() ? 0.0f : *std::max_element(areas.begin(), areas.end());
  const auto between = [&](std::size_t i, std::size_t j, double share) {
    // Where an outline cuts texels, it cuts their border too.
    if (!chart.closed()) share *= std::min(1.0, double(std::min(areas[i], areas[j])) / whole);
    return static_cast<float>(share);
  };
  for (int y = 0; y < height_; ++y) {
    const double t = region_.lower.y + y * texel.y;
    const double across = texel.x * chart.stretch(t + 0.5 * texel.y) * groupAt(chart, y);
    const double above = texel.x * chart.stretch(t + texel.y);
    for (int x = 0; x < width_; ++x) {
      const std::size_t i = texelAt(x, y);
      const int right = x + 1 < width_ ? x + 1 : (closed_ && width_ > 1 ? 0 : -1);
      if (right >= 0) shares.right[i] = between(i, texelAt(right, y), texel.y / across);
      if (y + 1 < height_) shares.above[i] = between(i, texelAt(x, y + 1), above / texel.y);
    }
  }
}

/// The nine-point form of the flow in squares of four whole cells: each diagonal takes over as much as the four sides
/// give, which leaves the flow of smooth light as it is and lets it run along slanting edges.
void CellGrid::shareDiagonals(const Chart& chart, std::span<const float> areas, const Cells& cells,
                              Shares& shares) const {
  if (width_ < 3) return;
  const Vec2 texel = region_.size() / Vec2(width_, height_);
  const float whole = areas.empty() ? 0.0f : *std::max_element(areas.begin(), areas.end());
  const auto isWhole = [&](std::size_t i) {
    const std::uint32_t cell = cellOf_[i];
    return cell != kNone && cells.areas[cell] < 1.01f * areas[i] && (chart.closed() || areas[i] > 0.99f * whole);
  };
  for (int y = 0; y + 1 < height_; ++y) {
    const double across = texel.x * chart.stretch(region_.lower.y + (y + 1) * texel.y);
    const auto share = static_cast<float>(std::min(across / texel.y, texel.y / across) / 6);
    for (int x = 0; x + (closed_ ? 0 : 1) < width_; ++x) {
      const int right = x + 1 < width_ ? x + 1 : 0;
      const std::size_t a = texelAt(x, y), b = texelAt(right, y), c = texelAt(x, y + 1), d = texelAt(right, y + 1);
      if (!isWhole(a) || !isWhole(b) || !isWhole(c) || !isWhole(d)) continue;
      shares.aboveRight[a] += share, shares.aboveLeft[b] += share;
      shares.right[a] -= share, shares.right[c] -= share, shares.above[a] -= share, shares.above[b] -= share;
    }
  }
}

/// Cells around a texel that share something with it.
void CellGrid::addNeighbours(std::size_t texel, const Shares& shares, std::vector<Border>& found) const {
  const int x = static_cast<int>(texel) % width_, y = static_cast<int>(texel) / width_;
  const bool turns = closed_ && width_ > 1;
  const int left = x > 0 ? x - 1 : turns ? width_ - 1 : -1, right = x + 1 < width_ ? x + 1 : turns ? 0 : -1;
  const auto add = [&](int nx, int ny, const std::vector<float>& share, std::size_t of, bool diagonal) {
    const std::uint32_t cell = cellOf_[texelAt(nx, ny)];
    if (cell != kNone && cell != cellOf_[texel] && share[of] > 0) found.push_back({cell, share[of], diagonal});
  };
  if (y > 0) {
    if (left >= 0) add(left, y - 1, shares.aboveRight, texelAt(left, y - 1), true);
    add(x, y - 1, shares.above, texelAt(x, y - 1), false);
    if (right >= 0) add(right, y - 1, shares.aboveLeft, texelAt(right, y - 1), true);
  }
  if (left >= 0) add(left, y, shares.right, texelAt(left, y), false);
  if (right >= 0) add(right, y, shares.right, texel, false);
  if (y + 1 < height_) {
    if (left >= 0) add(left, y + 1, shares.aboveLeft, texel, true);
    add(x, y + 1, shares.above, texel, false);
    if (right >= 0) add(right, y + 1, shares.aboveRight, texel, true);
  }
}

std::uint32_t CellGrid::texelNear(const Vec2& st) const {
  const Vec2 at = (st - region_.lower) / region_.size() * Vec2(width_, height_);
  const int x = std::clamp(static_cast<int>(std::floor(at.x)), 0, width_ - 1);
  const int y = std::clamp(static_cast<int>(std::floor(at.y)), 0, height_ - 1);
  if (cellOf_[texelAt(x, y)] != kNone) return static_cast<std::uint32_t>(texelAt(x, y));
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

}  // namespace deltalux
