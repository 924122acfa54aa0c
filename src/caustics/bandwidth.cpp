#include "caustics/bandwidth.hpp"

#include <algorithm>

namespace deltalux {

namespace {

constexpr double kNarrowest = 0.5;       // standard deviation in cells
constexpr double kConfidence = 3;        // standard deviations of a difference that noise explains
constexpr double kLeastParticles = 4.0;  // that a kernel expects when it is asked
constexpr double kEnough = 16;           // particles that tell how noisy they are
constexpr double kQuiet = 0.5;           // of the target error: noise that a kernel need not grow to reduce
constexpr double kBlend = 1.0;           // standard deviation in cells, of the blending of widths

/// Where the widths are compared.
struct Place {
  std::size_t cell;
  double area, meanArea;

  /// Of a kernel here: cells cut by an outline are noisier than others.
  double overlap(const ScaleLevel& l) const {
    return area < 0.9 * meanArea ? kernelOverlap(l.width, l.width, area) : l.overlap;
  }
};

bool contradict(const ScaleLevel& wide, const ScaleLevel& narrow, const Place& at) {
  const double squares = wide.squares(at.cell), E = wide.E(at.cell), overlap = at.overlap(narrow);
  if (E * E / squares / overlap < kLeastParticles) return false;
  const double both = kernelOverlap(wide.width, narrow.width, at.meanArea);
  const double variance = squares * (overlap + wide.overlap - 2 * both);
  const double difference = E - narrow.light[at.cell].x;
  return difference * difference > kConfidence * kConfidence * variance;
}

/// Density of squares as seen by the narrowest kernel that holds particles enough to tell, or the widest one: where no
/// particle fell, narrower ones know no noise.
double squaresAround(const std::vector<ScaleLevel>& levels, std::size_t cell) {
  for (const ScaleLevel& l : levels)
    if (l.count(cell) >= kEnough) return l.squares(cell);
  return levels.back().squares(cell);
}

/// The width of the widest kernel that all narrower ones bear out.
double widthAt(const std::vector<ScaleLevel>& levels, const Place& at, const BandwidthRule& rule) {
  const double around = squaresAround(levels, at.cell);
  std::size_t k = 1;
  for (; k < levels.size(); ++k) {
    const auto narrower = levels.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::any_of(levels.begin(), narrower, [&](const ScaleLevel& l) { return contradict(levels[k], l, at); })) break;
    const double allowed = kQuiet * rule.error * (levels[k].E(at.cell) + rule.darkest);
    if (std::max(levels[k].squares(at.cell), around) * levels[k].overlap <= allowed * allowed) return levels[k].width;
  }
  return levels[k - 1].width;
}

}  // namespace

std::vector<float> chooseBandwidths(const CellGrid& grid, const CellLight& light, Openness open,
                                    const BandwidthRule& rule) {
  const std::vector<ScaleLevel> levels = scaleSpace(grid, light, open);
  const double area = grid.meanArea(), narrowest = kNarrowest * std::sqrt(area);
  std::vector<float> logs;
  for (std::size_t i = 0; i < grid.size(); ++i)
    logs.push_back(static_cast<float>(std::log(std::max(widthAt(levels, {i, grid.area(i), area}, rule), narrowest))));
  // Choices are noisy too: their logarithms blend with their neighbours'.
  HeatFlow(grid, std::vector<float>(grid.size(), 1.0f), open).apply(logs, 0.5 * kBlend * kBlend * area);
  for (float& l : logs) l = 0.5f * std::exp(2 * l);
  return logs;
}

}  // namespace deltalux
