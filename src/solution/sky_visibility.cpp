#include "solution/sky_visibility.hpp"

#include "base/parallel.hpp"

namespace deltalux {

namespace {

/// The cell of the sky that a line's code points into: there are fewer codes than lines.
class CellOfCode {
 public:
  CellOfCode() : cells_(kCodes * kCodes) {
    parallelFor(kCodes, kRows, [&](std::size_t y) {
      for (std::size_t x = 0; x < kCodes; ++x) {
        lines::LineCode code;
        code.x = static_cast<std::int8_t>(static_cast<int>(x) - 128);
        code.y = static_cast<std::int8_t>(static_cast<int>(y) - 128);
        cells_[y * kCodes + x] = static_cast<std::uint16_t>(direct::SkyCells::of(lines::direction(code)));
      }
    });
  }
  int operator()(lines::LineCode code) const {
    return cells_[static_cast<std::size_t>(code.y + 128) * kCodes + static_cast<std::size_t>(code.x + 128)];
  }

 private:
  static constexpr std::size_t kCodes = 256, kRows = 16;  // [layout]
  std::vector<std::uint16_t> cells_;
};

}  // namespace

direct::SkyVisibility skyVisibility(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                                    const lines::Lines& lines) {
  std::vector<std::uint32_t> counts(leaves.size(), 0);
  for (std::size_t i = 0; i < lines.leaves(); ++i) counts[i] = lines.countOf(i);
  const CellOfCode cellOf;
  return {elements, leaves, counts, [&](std::size_t leaf, const auto& sink) {
            if (counts[leaf] == 0) return;
            for (std::uint64_t k = lines.first[leaf]; k < lines.first[leaf + 1]; ++k)
              if (lines.end[k] != lines::kCovered) sink(cellOf(lines.code[k]), lines.end[k] == lines::kEscaped);
          }};
}

}  // namespace deltalux
