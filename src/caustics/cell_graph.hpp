#pragma once
// Cells of a surface that light can be smoothed over: every cell has its area, and what it shares with each neighbour.
//
// Cells that have their neighbours at the same distances in the order of cells, as those of a row inside a surface,
// form runs; what belongs to borders is kept run by run, one neighbour after the other, so that a pass over all borders
// is arithmetic on arrays.
#include <cstdint>
#include <deltalux/math.hpp>
#include <span>
#include <vector>

namespace deltalux {

class CellGraph {
 public:
  static constexpr std::size_t kMostNeighbours = 8;

  struct Border {
    std::uint32_t cell;
    float share;     // length of the common border over the distance between the centres
    bool diagonal;   // touching at a corner; where cells are alike, light flows that way too, at the cost of the sides
    float open = 1;  // in [0, 1]: of what it could let through
  };
  /// A cell with more neighbours than kMostNeighbours has several runs of its own, one after the other.
  struct Run {
    std::uint32_t first = 0, count = 0;  // cells
    std::uint32_t borders = 0;           // that of cell first + i with the k-th neighbour is borders + k * count + i
    std::uint32_t neighbours = 0;
    std::int32_t offset[kMostNeighbours] = {};  // of a neighbour's cell
    bool diagonal[kMostNeighbours] = {};
  };

  CellGraph() = default;
  /// By cell: its area; where it stands, in rows and columns; its neighbours, from firstBorder[cell] on, ascending.
  CellGraph(std::vector<float> areas, std::vector<glm::ivec2> places, std::span<const std::uint32_t> firstBorder,
            std::span<const Border> borders);

  std::size_t size() const { return area_.size(); }
  float area(std::size_t cell) const { return area_[cell]; }
  std::span<const float> areas() const { return area_; }
  glm::ivec2 place(std::size_t cell) const { return place_[cell]; }
  double totalArea() const { return totalArea_; }
  /// Mean of the cells' areas; 0 without cells.
  double meanArea() const { return area_.empty() ? 0.0 : totalArea_ / static_cast<double>(area_.size()); }

  std::span<const Run> runs() const { return runs_; }
  std::size_t borders() const { return share_.size(); }
  std::span<const float> shares() const { return share_; }
  std::span<const float> open() const { return open_; }

  /// body(cell, its neighbour, index of the border, whether it is diagonal), twice for each pair.
  template <class Body>
  void forEachBorder(const Body& body) const {
    for (const Run& run : runs_)
      for (std::uint32_t k = 0; k < run.neighbours; ++k)
        for (std::uint32_t i = 0; i < run.count; ++i)
          body(run.first + i, run.first + i + static_cast<std::uint32_t>(run.offset[k]),
               run.borders + k * run.count + i, run.diagonal[k]);
  }

 private:
  std::vector<float> area_;
  std::vector<glm::ivec2> place_;
  double totalArea_ = 0;
  std::vector<Run> runs_;
  std::vector<float> share_, open_;  // by border
};

}  // namespace deltalux
