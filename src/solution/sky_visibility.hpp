#pragma once
// How open the sky is about each leaf of a solution, by all the lines that were traced below a common element; without
// lines, alike everywhere.
#include "direct/sky_light.hpp"
#include "lines/lines.hpp"

namespace deltalux {

/// The cell of the sky that a line's code points into: there are fewer codes than lines.
class CellOfCode {
 public:
  /// Made when it is first asked for.
  static const CellOfCode& table();
  int operator()(lines::LineCode code) const {
    return cells_[static_cast<std::size_t>(code.y + 128) * kCodes + static_cast<std::size_t>(code.x + 128)];
  }

 private:
  CellOfCode();

  static constexpr std::size_t kCodes = 256;  // [layout]
  std::vector<std::uint16_t> cells_;
};

/// `known`: of lines that `before` was counted from; both or neither.
direct::SkyVisibility skyVisibility(const hierarchy::Elements&, const hierarchy::LeafTable&, const lines::Lines&,
                                    const direct::SkyVisibility* before = nullptr,
                                    const lines::KnownLines* known = nullptr);

}  // namespace deltalux
