#include "solution/sky_visibility.hpp"

#include "base/parallel.hpp"

namespace deltalux {

CellOfCode::CellOfCode() : cells_(kCodes * kCodes) {
  // By one thread: others may wait for it.
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    lines::LineCode code;
    code.x = static_cast<std::int8_t>(static_cast<int>(i % kCodes) - 128);
    code.y = static_cast<std::int8_t>(static_cast<int>(i / kCodes) - 128);
    cells_[i] = static_cast<std::uint16_t>(direct::SkyCells::of(lines::direction(code)));
  }
}

const CellOfCode& CellOfCode::table() {
  static const CellOfCode table;
  return table;
}

direct::SkyVisibility skyVisibility(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                                    const lines::Lines& lines, const direct::SkyVisibility* before,
                                    const lines::KnownLines* known) {
  std::vector<std::uint32_t> counts(leaves.size(), 0);
  if (!lines.empty())
    for (std::size_t i = 0; i < leaves.size(); ++i) counts[i] = lines.countOf(leaves[i]);
  const CellOfCode& cellOf = CellOfCode::table();
  const auto forEachLineOf = [&](std::size_t leaf, const auto& sink) {
    if (counts[leaf] == 0) return;
    const std::span<const std::uint32_t> ends = lines.endsOf(leaves[leaf]);
    const std::span<const lines::LineCode> codes = lines.codesOf(leaves[leaf]);
    for (std::size_t k = 0; k < ends.size(); ++k)
      if (ends[k] != lines::kCovered) sink(cellOf(codes[k]), ends[k] == lines::kEscaped);
  };
  const auto same = [&](std::uint32_t leaf) { return known->same(leaves[leaf], lines); };
  return {elements, leaves, counts, forEachLineOf, known ? before : nullptr, same};
}

}  // namespace deltalux
