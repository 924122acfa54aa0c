#include "caustics/cell_raster.hpp"

#include <algorithm>

namespace deltalux::caustics {

namespace {
constexpr std::size_t kVector = 16;  // values [task]
constexpr float kOneTexel = 1.01f;   // times its area: more is several texels [rounding]
}  // namespace

CellRaster::CellRaster(const CellGrid& grid)
    : width_(grid.width()),
      height_(grid.height()),
      stride_((static_cast<std::size_t>(grid.width()) + 2 + kVector - 1) / kVector * kVector),
      closed_(grid.closed() && grid.width() > 1),
      meanArea_(grid.meanArea()),
      totalArea_(grid.totalArea()),
      slotOf_(grid.size()),
      cellOf_(grid.cells().begin(), grid.cells().end()) {
  const std::size_t count = 2 * kRim + stride_ * (rows() + 2);
  areas_.assign(count, 0.0f), cellAreas_.assign(count, 0.0f);
  for (Slots& s : shares_) s.assign(count, 0.0f);
  // How much of each texel takes part in its borders, and whether it is all of an uncut texel.
  const std::span<const float> texels = grid.texelAreas();
  const float largest = texels.empty() ? 0.0f : *std::max_element(texels.begin(), texels.end());
  Slots present(count, 0.0f), whole(count, 0.0f);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const std::size_t texel = static_cast<std::size_t>(y) * width_ + x, slot = rowBegin(y) + 1 + x;
      const std::uint32_t cell = grid.cellOf(texel);
      if (cell == CellGrid::kNone) continue;
      const bool own = grid.texelOf(cell) == texel;
      if (own) slotOf_[cell] = static_cast<std::uint32_t>(slot);
      if (!own && !grid.unrolled()) continue;
      cellAreas_[slot] = grid.area(cell);
      areas_[slot] = grid.unrolled() ? texels[texel] : grid.area(cell);
      present[slot] = grid.unrolled() ? 1.0f : texels[texel] / largest;
      whole[slot] =
          grid.area(cell) < kOneTexel * texels[texel] && (grid.unrolled() || texels[texel] > kWhole * largest);
    }
  firstGroup_.assign(rows() + 1, 0);
  if (grid.unrolled()) findGroups();
  closeRows(present), closeRows(whole);
  shareSides(grid, present);
  if (!grid.unrolled()) shareSlivers(grid, largest);
  shareDiagonals(grid, whole);
  for (Slots& s : shares_) closeRows(s);
}

void CellRaster::findGroups() {
  for (int y = 0; y < height_; ++y) {
    for (int x = 0, end = 0; x < width_; x = end) {
      const std::size_t texel = static_cast<std::size_t>(y) * width_;
      const std::uint32_t cell = cellOf_[texel + x];
      for (end = x + 1; end < width_ && cell != CellGrid::kNone && cellOf_[texel + end] == cell;) ++end;
      if (end - x > 1)
        groups_.push_back({static_cast<std::uint32_t>(rowBegin(y) + 1 + x), static_cast<std::uint32_t>(end - x)});
    }
    firstGroup_[static_cast<std::size_t>(y) + 1] = static_cast<std::uint32_t>(groups_.size());
  }
}

void CellRaster::shareSides(const CellGrid& grid, const Slots& present) {
  const Vec2 texel = grid.texelSize();
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::size_t begin = rowBegin(row);
    const auto right = static_cast<float>(texel.y / grid.widthOfCells(static_cast<int>(row)));
    const auto above = static_cast<float>(grid.lengthAbove(static_cast<int>(row)) / texel.y);
    // Where an outline cuts texels, it cuts their border too.
    const float *here = present.data() + begin, *next = here + 1, *up = here + stride_;
    float *toRight = shares_[0].data() + begin, *toAbove = shares_[1].data() + begin;
    for (std::size_t i = 0; i < stride_; ++i) {
      toRight[i] = right * std::min(here[i], next[i]);
      toAbove[i] = above * std::min(here[i], up[i]);
    }
    for (std::uint32_t g = firstGroup_[row]; g < firstGroup_[row + 1]; ++g)
      std::fill_n(shares_[0].begin() + groups_[g].first, groups_[g].count - 1, 0.0f);
  }
}

/// What texels share that were joined to others belongs to those, as far as they lie next to each other.
void CellRaster::shareSlivers(const CellGrid& grid, float largest) {
  const std::span<const float> areas = grid.texelAreas();
  const Vec2 size = grid.texelSize();
  const auto join = [&](std::size_t a, std::size_t b, double share) {
    if (cellOf_[a] == cellOf_[b] || cellOf_[a] == CellGrid::kNone || cellOf_[b] == CellGrid::kNone) return;
    std::size_t from = slotOf_[cellOf_[a]], to = slotOf_[cellOf_[b]];
    if (from > to) std::swap(from, to);
    const auto steps = across();
    for (std::size_t border = 0; border < steps.size(); ++border)
      if (to - from == steps[border])
        shares_[border][from] += static_cast<float>(share) * std::min(areas[a], areas[b]) / largest;
  };
  const auto isSliver = [&](std::size_t texel) {
    return cellOf_[texel] != CellGrid::kNone && grid.texelOf(cellOf_[texel]) != texel;
  };
  const std::size_t width = static_cast<std::size_t>(width_);
  for (std::size_t i = 0; i < cellOf_.size(); ++i) {
    const bool right = (i + 1) % width != 0, above = i + width < cellOf_.size(), sliver = isSliver(i);
    if (right && (sliver || isSliver(i + 1))) join(i, i + 1, size.y / size.x);
    if (above && (sliver || isSliver(i + width))) join(i, i + width, size.x / size.y);
  }
}

/// The nine-point form of the flow in squares of four whole cells: each diagonal takes over as much as the four sides
/// give, which leaves the flow of smooth light as it is and lets it run along slanting edges.
void CellRaster::shareDiagonals(const CellGrid& grid, const Slots& whole) {
  if (width_ < 3) return;
  const double height = grid.texelSize().y;
  Slots squares(slots(), 0.0f);  // by their lower left slot
  for (std::size_t row = 0; row + 1 < rows(); ++row) {
    const std::size_t begin = rowBegin(row);
    const double width = grid.lengthAbove(static_cast<int>(row));
    const auto share = static_cast<float>(std::min(width / height, height / width) / 6);
    const float *here = whole.data() + begin, *up = here + stride_;
    float* to = squares.data() + begin;
    for (std::size_t i = 0; i < stride_; ++i) to[i] = share * here[i] * here[i + 1] * up[i] * up[i + 1];
  }
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::size_t begin = rowBegin(row);
    const float *square = squares.data() + begin, *left = square - 1, *below = square - stride_;
    float *right = shares_[0].data() + begin, *above = shares_[1].data() + begin;
    float *aboveRight = shares_[2].data() + begin, *aboveLeft = shares_[3].data() + begin;
    for (std::size_t i = 0; i < stride_; ++i) {
      right[i] -= square[i] + below[i], above[i] -= square[i] + left[i];
      aboveRight[i] = square[i], aboveLeft[i] = left[i];
    }
  }
}

Slots CellRaster::laidOut(std::span<const float> cells) const {
  Slots result(slots(), 0.0f);
  for (std::size_t row = 0, texel = 0; row < rows(); ++row)
    for (std::size_t slot = rowBegin(row) + 1, end = slot + width_; slot < end; ++slot, ++texel)
      if (cellOf_[texel] != CellGrid::kNone) result[slot] = cells[cellOf_[texel]];
  closeRows(result);
  return result;
}

void CellRaster::even(std::size_t row, float* values) const {
  if (!closed_ && groups_.empty()) return;
  for (std::uint32_t g = firstGroup_[row]; g < firstGroup_[row + 1]; ++g) {
    float* const first = values + groups_[g].first;
    float sum = 0;
    for (std::uint32_t i = 0; i < groups_[g].count; ++i) sum += first[i];
    std::fill_n(first, groups_[g].count, sum / static_cast<float>(groups_[g].count));
  }
  if (closed_) closeRow(row, values);
}

void CellRaster::closeRow(std::size_t row, float* values) const {
  float* const first = values + rowBegin(row);
  first[0] = first[width_], first[width_ + 1] = first[1];
}

void CellRaster::closeRows(Slots& values) const {
  if (!closed_) return;
  for (std::size_t row = 0; row < rows(); ++row) closeRow(row, values.data());
}

float CellRaster::mostPerArea(const Slots& values) const {
  std::array<float, kVector> most{};
  Slots grouped;
  const float* v = values.data();
  if (!groups_.empty()) {
    grouped = values;
    for (std::size_t row = 0; row < rows(); ++row) even(row, grouped.data());
    v = grouped.data();
  }
  const float* const a = areas_.data();
  for (std::size_t i = kRim; i + kVector <= slots(); i += kVector)
    for (std::size_t k = 0; k < kVector; ++k) {
      const float ratio = a[i + k] > 0 ? v[i + k] / a[i + k] : 0.0f;
      most[k] = ratio > most[k] ? ratio : most[k];
    }
  return *std::max_element(most.begin(), most.end());
}

}  // namespace deltalux::caustics
