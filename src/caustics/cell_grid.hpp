#pragma once
// The grid of a caustic texture as cells that light can be smoothed over: every cell has its true area, and what it
// shares with each neighbour. Smoothing that works on cells needs to know nothing of outlines, seams and poles:
//   - texels beyond the outline have no cell; flux that rounds into them goes to the nearest that has one;
//   - slivers of texels at an outline are joined to a neighbour;
//   - on a closed chart the last column borders on the first;
//   - towards a pole texels grow thin: those of a row join until they are at least half as wide as high, so that all
//     meet around the pole (a reduced grid).
#include <cstdint>
#include <span>

#include "caustics/chart.hpp"
#include "caustics/region.hpp"

namespace deltalux {

class CellGrid {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  /// `areas`: of the surface under each texel (coverage.hpp); 0 where there is none. A region as wide as a closed chart
  /// closes too.
  CellGrid(const Chart&, const Region&, int width, int height, std::span<const float> areas);

  int width() const { return width_; }
  int height() const { return height_; }
  bool closed() const { return closed_; }
  bool poleAtStart() const { return poleAtStart_; }
  bool poleAtEnd() const { return poleAtEnd_; }
  const Region& region() const { return region_; }

  std::size_t size() const { return area_.size(); }
  /// The cell of a texel; kNone where there is no surface.
  std::uint32_t cellOf(std::size_t texel) const { return cellOf_[texel]; }
  float area(std::size_t cell) const { return area_[cell]; }
  double totalArea() const { return totalArea_; }
  /// Mean of the cells' areas; 0 without cells.
  double meanArea() const { return area_.empty() ? 0.0 : totalArea_ / static_cast<double>(area_.size()); }

  /// The texel nearest to a chart point that has a cell; kNone when the grid has none at all.
  std::uint32_t texelNear(const Vec2& st) const;
  /// Its cell.
  std::uint32_t cellAt(const Vec2& st) const {
    const std::uint32_t texel = texelNear(st);
    return texel == kNone ? kNone : cellOf_[texel];
  }

  struct Border {
    std::uint32_t cell;
    float share;    // length of the common border over the distance between the centres
    bool diagonal;  // touching at a corner; where cells are alike, light flows that way too, at the cost of the sides
  };
  std::span<const Border> bordersOf(std::size_t cell) const {
    return {borders_.data() + firstBorder_[cell], firstBorder_[cell + 1] - firstBorder_[cell]};
  }

 private:
  void joinTowardsPoles(const Chart&, std::span<const float> areas);
  void joinSlivers(std::span<const float> areas);
  void numberCells(std::span<const float> areas);
  struct Shared {
    std::uint32_t a, b;
    float share;
    bool diagonal;
  };
  struct Shares;
  void findBorders(const Chart&, std::span<const float> areas);
  void shareSides(const Chart&, std::span<const float> areas, Shares&) const;
  void shareDiagonals(const Chart&, std::span<const float> areas, Shares&) const;
  void addNeighbours(std::size_t texel, const Shares&, std::vector<Border>& found) const;
  void addMerged(std::vector<Border>& found);
  int groupAt(const Chart&, int row) const;

  std::size_t texelAt(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  Region region_;
  int width_, height_;
  bool closed_, poleAtStart_, poleAtEnd_;
  std::vector<std::uint32_t> cellOf_;
  std::vector<float> area_;
  double totalArea_ = 0;
  std::vector<std::uint32_t> firstBorder_;
  std::vector<Border> borders_;
};

}  // namespace deltalux
