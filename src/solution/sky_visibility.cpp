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
                                    const lines::Lines& lines) {
  std::vector<std::uint32_t> counts(leaves.size(), 0);
  for (std::size_t i = 0; i < lines.leaves(); ++i) counts[i] = lines.countOf(i);
  const CellOfCode& cellOf = CellOfCode::table();
  return {elements, leaves, counts, [&](std::size_t leaf, const auto& sink) {
            if (counts[leaf] == 0) return;
            for (std::uint64_t k = lines.first[leaf]; k < lines.first[leaf + 1]; ++k)
              if (lines.end[k] != lines::kCovered) sink(cellOf(lines.code[k]), lines.end[k] == lines::kEscaped);
          }};
}

}  // namespace deltalux
