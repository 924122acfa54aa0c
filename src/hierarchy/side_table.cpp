#include "hierarchy/side_table.hpp"

#include <algorithm>

namespace deltalux {

namespace {
std::uint32_t placeOf(const Side& s) { return 2 * s.triangle + (s.front ? 0 : 1); }
}  // namespace

void SideTable::add(const Side& side, ElementId element) {
  if (side.primitive.index() >= ranges_.size()) ranges_.resize(side.primitive.index() + 1);
  Range& r = ranges_[side.primitive.index()];
  const std::uint32_t place = placeOf(side);
  if (place >= r.count) {  // moves to where there is room
    const Range wider{static_cast<std::uint32_t>(sides_.size()), std::max(2 * (side.triangle + 1), 2 * r.count)};
    sides_.resize(wider.first + wider.count);
    std::copy_n(sides_.begin() + r.first, r.count, sides_.begin() + wider.first);
    r = wider;
  }
  sides_[r.first + place] = element;
}

ElementId SideTable::at(const Side& side) const {
  if (side.primitive.index() >= ranges_.size()) return {};
  const Range& r = ranges_[side.primitive.index()];
  const std::uint32_t place = placeOf(side);
  return place < r.count ? sides_[r.first + place] : ElementId();
}

std::size_t SideTable::memoryBytes() const {
  return ranges_.capacity() * sizeof(Range) + sides_.capacity() * sizeof(ElementId);
}

}  // namespace deltalux
