#pragma once
// The cells of a grid laid out in rows, as passes over all of them want it: arrays of slots, a slot for each texel,
// with a rim of empty slots around them and rows a multiple of the widest vectors long. A pass needs no lists and no
// cases: what does not exist has no area, and shares nothing.
//
//   - Every two slots that touch share a border: its length over the distance between the centres. It is kept once, for
//     the slot and the one to its right, above it, and above to its right and left.
//   - A texel that was joined to another because an outline leaves little of it has no slot of its own; its borders are
//     the other's.
//   - The texels that make one cell towards a pole all hold the cell's value: `even` brings them together again.
//   - On a closed grid the rim repeats the other end of the row.
// Cost: some nanoseconds a texel.
#include <array>
#include <span>

#include "caustics/cell_grid.hpp"
#include "caustics/slots.hpp"

namespace deltalux::caustics {

/// Of several things.
using Channels = std::vector<Slots>;
/// By slot: what belongs to the borders with the ones to the right, above, above right and above left.
using Borders = std::array<Slots, 4>;

class CellRaster {
 public:
  static constexpr float kWhole = 0.99f;  // of the largest area: less is cut by an outline [rounding]

  explicit CellRaster(const CellGrid&);

  std::size_t slots() const { return areas_.size(); }
  std::size_t rows() const { return static_cast<std::size_t>(height_); }
  std::size_t rowBegin(std::size_t row) const { return kRim + (row + 1) * stride_; }
  std::size_t stride() const { return stride_; }
  /// From a slot to the one on the other side of each of its four borders.
  std::array<std::size_t, 4> across() const { return {1, stride_, stride_ + 1, stride_ - 1}; }

  /// Of the surface under each slot [unit^2]; 0: no cell.
  const Slots& areas() const { return areas_; }
  /// That of the whole cell.
  const Slots& cellAreas() const { return cellAreas_; }
  const Borders& shares() const { return shares_; }
  double meanArea() const { return meanArea_; }
  double totalArea() const { return totalArea_; }

  /// From values by cell.
  Slots laidOut(std::span<const float> cells) const;
  std::uint32_t slotOf(std::uint32_t cell) const { return slotOf_[cell]; }

  /// Gives all texels of a cell its mean, and repeats the ends of a closed row.
  void even(std::size_t row, float* values) const;
  void even(Slots& values) const {
    for (std::size_t row = 0; row < rows(); ++row) even(row, values.data());
  }
  /// Values that `even` leaves as they are: only the ends of closed rows.
  void closeRows(Slots& values) const;

  /// The largest sum of values over the area of a cell.
  float mostPerArea(const Slots& values) const;

 private:
  static constexpr std::size_t kRim = 16;  // slots before the first row and after the last [layout]
  struct Group {
    std::uint32_t first, count;  // slots that are one cell
  };

  void shareSides(const CellGrid&, const Slots& present);
  void shareSlivers(const CellGrid&, float largest);
  void shareDiagonals(const CellGrid&, const Slots& whole);
  void findGroups();
  void closeRow(std::size_t row, float* values) const;

  int width_, height_;
  std::size_t stride_;
  bool closed_;
  double meanArea_, totalArea_;
  Slots areas_, cellAreas_;
  Borders shares_;
  std::vector<std::uint32_t> slotOf_;      // by cell
  std::vector<std::uint32_t> cellOf_;      // by texel
  std::vector<Group> groups_;              // by row
  std::vector<std::uint32_t> firstGroup_;  // of each row, and the end
};

}  // namespace deltalux::caustics
