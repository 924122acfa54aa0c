#pragma once
// The grid of a caustic texture as cells that light can be smoothed over: every cell has its true area, and what it
// shares with each neighbour. Smoothing that works on cells needs to know nothing of outlines, seams and poles:
//   - texels beyond the outline have no cell; flux that rounds into them goes to the nearest that has one;
//   - slivers of texels at an outline are joined to a neighbour;
//   - on a closed chart the last column borders on the first;
//   - towards a pole texels grow thin: those of a row join until they are at least half as wide as high, so that all
//     meet around the pole (a reduced grid).
#include "caustics/cell_graph.hpp"
#include "caustics/chart.hpp"
#include "caustics/region.hpp"

namespace deltalux {

class CellGrid : public CellGraph {
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

  /// The cell of a texel; kNone where there is no surface.
  std::uint32_t cellOf(std::size_t texel) const { return cellOf_[texel]; }

  /// The texel nearest to a chart point that has a cell; kNone when the grid has none at all.
  std::uint32_t texelNear(const Vec2& st) const;
  /// Its cell.
  std::uint32_t cellAt(const Vec2& st) const {
    const std::uint32_t texel = texelNear(st);
    return texel == kNone ? kNone : cellOf_[texel];
  }

 private:
  void joinTowardsPoles(const Chart&, std::span<const float> areas);
  void joinSlivers(std::span<const float> areas);
  struct Cells;
  Cells numberCells(std::span<const float> areas);
  struct Shares;
  CellGraph findBorders(const Chart&, std::span<const float> areas, Cells) const;
  void shareSides(const Chart&, std::span<const float> areas, Shares&) const;
  void shareDiagonals(const Chart&, std::span<const float> areas, const Cells&, Shares&) const;
  void addNeighbours(std::size_t texel, const Shares&, std::vector<Border>& found) const;
  int groupAt(const Chart&, int row) const;

  std::size_t texelAt(int x, int y) const { return static_cast<std::size_t>(y) * width_ + x; }

  Region region_;
  int width_, height_;
  bool closed_, poleAtStart_, poleAtEnd_;
  std::vector<std::uint32_t> cellOf_;
};

}  // namespace deltalux
