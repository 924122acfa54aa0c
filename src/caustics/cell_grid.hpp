#pragma once
// The grid of a caustic texture as cells that light can be smoothed over, each with its true area. What works on cells
// (cell_raster.hpp) needs to know nothing of outlines, seams and poles:
//   - texels beyond the outline have no cell; flux that rounds into them goes to the nearest that has one;
//   - slivers of texels at an outline are joined to a neighbour;
//   - on a closed chart the last column borders on the first;
//   - towards a pole texels grow thin: those of a row join until they are at least half as wide as high, so that all
//     meet around the pole (a reduced grid).
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "caustics/chart.hpp"
#include "caustics/region.hpp"

namespace deltalux::caustics {

class CellGrid {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  /// `areas`: of the surface under each texel (coverage.hpp); 0 where there is none. A region as wide as a closed chart
  /// closes too.
  CellGrid(const Chart&, const Region&, int width, int height, std::span<const float> areas);

  std::size_t size() const { return areas_.size(); }  // cells
  float area(std::size_t cell) const { return areas_[cell]; }
  std::span<const float> areas() const { return areas_; }
  double totalArea() const { return totalArea_; }
  /// Mean of the cells' areas; 0 without cells.
  double meanArea() const { return areas_.empty() ? 0.0 : totalArea_ / static_cast<double>(areas_.size()); }

  int width() const { return width_; }
  int height() const { return height_; }
  bool closed() const { return closed_; }
  bool poleAtStart() const { return poleAtStart_; }
  bool poleAtEnd() const { return poleAtEnd_; }
  const Region& region() const { return region_; }

  /// Whether the chart is that of a surface of revolution, be the region all of it or not.
  bool unrolled() const { return chart_.closed(); }
  Vec2 texelSize() const { return region_.size() / Vec2(width_, height_); }
  /// True length across the cells of a row, at their middle; of the border between a texel and the one above it.
  double widthOfCells(int row) const;
  double lengthAbove(int row) const;

  /// Of the surface under each texel.
  std::span<const float> texelAreas() const { return texelAreas_; }
  /// The cell of a texel; kNone where there is no surface.
  std::uint32_t cellOf(std::size_t texel) const { return cellOf_[texel]; }
  std::span<const std::uint32_t> cells() const { return cellOf_; }
  /// The texel that the others of a cell were joined to.
  std::uint32_t texelOf(std::uint32_t cell) const { return texels_[cell]; }

  /// The texel nearest to a chart point that has a cell; kNone when the grid has none at all.
  std::uint32_t texelNear(const Vec2& st) const {
    const Vec2 at = (st - region_.lower) * perUnit_;
    const int x = std::clamp(static_cast<int>(at.x), 0, width_ - 1),
              y = std::clamp(static_cast<int>(at.y), 0, height_ - 1);
    const std::size_t texel = texelAt(x, y);
    return cellOf_[texel] != kNone ? static_cast<std::uint32_t>(texel) : texelAround(at);
  }
  /// Its cell.
  std::uint32_t cellAt(const Vec2& st) const {
    const std::uint32_t texel = texelNear(st);
    return texel == kNone ? kNone : cellOf_[texel];
  }

 private:
  std::uint32_t texelAround(const Vec2& at) const;
  void joinTowardsPoles();
  void joinSlivers();
  void numberCells();
  int groupAt(int row) const;

  std::size_t texelAt(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  Chart chart_;
  Region region_;
  Vec2 perUnit_;  // texels
  int width_, height_;
  bool closed_, poleAtStart_, poleAtEnd_;
  double totalArea_ = 0;
  std::vector<float> texelAreas_;      // by texel
  std::vector<std::uint32_t> cellOf_;  // by texel
  std::vector<float> areas_;           // by cell
  std::vector<std::uint32_t> texels_;  // by cell
};

}  // namespace deltalux::caustics
