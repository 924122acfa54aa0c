#include "caustics/bandwidth.hpp"

#include <algorithm>

namespace deltalux {

namespace {

constexpr double kNarrowest = 0.5;       // standard deviation in cells
constexpr double kWidest = 8;            // in cells
constexpr double kConfidence = 3;        // standard deviations of a difference that noise explains
constexpr double kLeastParticles = 4.0;  // that a kernel expects when it is asked
constexpr double kEnough = 16;           // particles that tell how noisy they are
constexpr double kQuiet = 0.5;           // of the target error: noise that a kernel need not grow to reduce
constexpr double kCut = 0.9;             // of the mean area: less is cut by an outline
constexpr double kFew = 0.02;            // of the cells: not worth another level
constexpr double kBlend = 1.0;           // standard deviation in cells, of the blending of widths

/// The overlaps of a level's kernel with all narrower ones', and theirs with themselves.
struct Overlaps {
  std::vector<double> both, narrow;

  Overlaps(const std::vector<ScaleLevel>& levels, double area) {
    for (const ScaleLevel& l : levels)
      both.push_back(kernelOverlap(levels.back().width, l.width, area)), narrow.push_back(l.overlap);
  }
};

/// Whether a narrower kernel denies the widest one.
bool contradicted(const std::vector<ScaleLevel>& levels, std::size_t cell, const Overlaps& overlaps) {
  const ScaleLevel& wide = levels.back();
  const double squares = wide.squares(cell), E = wide.E(cell), seen = E * E / (kLeastParticles * squares);
  for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
    const double overlap = overlaps.narrow[k];
    if (seen < overlap) continue;  // it expects too few particles to be asked
    const double variance = squares * (overlap + wide.overlap - 2 * overlaps.both[k]);
    const double difference = E - levels[k].light[0][cell];
    if (difference * difference > kConfidence * kConfidence * variance) return true;
  }
  return false;
}

/// Widths are looked for level by level; few cells that want yet another are left with what there is.
class WidthSearch {
 public:
  WidthSearch(const CellGraph& grid, const BandwidthRule& rule)
      : grid_(grid), rule_(rule), width_(grid.size(), 0.0), around_(grid.size(), -1.0) {
    for (std::uint32_t i = 0; i < grid.size(); ++i) open_.push_back(i);
  }

  /// Whether most cells are content with the last of these levels, or a narrower one.
  bool judge(const std::vector<ScaleLevel>& levels) {
    const Overlaps whole(levels, grid_.meanArea());
    std::erase_if(open_, [&](std::uint32_t cell) {
      if (grid_.area(cell) >= kCut * grid_.meanArea()) return decide(levels, cell, whole);
      // Cells that an outline cuts are noisier than others.
      Overlaps cut = whole;
      for (std::size_t k = 0; k < levels.size(); ++k)
        cut.narrow[k] = kernelOverlap(levels[k].width, levels[k].width, grid_.area(cell));
      return decide(levels, cell, cut);
    });
    return static_cast<double>(open_.size()) <= kFew * static_cast<double>(grid_.size());
  }

  const std::vector<double>& widths() const { return width_; }

 private:
  /// The width of the widest kernel that all narrower ones bear out.
  bool decide(const std::vector<ScaleLevel>& levels, std::uint32_t cell, const Overlaps& overlaps) {
    const ScaleLevel& last = levels.back();
    if (contradicted(levels, cell, overlaps)) return true;
    width_[cell] = last.width;
    // Where no particle fell, narrow kernels know no noise: the first that holds some tells.
    if (around_[cell] < 0 && last.count(cell) >= kEnough) around_[cell] = last.squares(cell);
    const double allowed = kQuiet * rule_.error * (last.E(cell) + rule_.darkest);
    return around_[cell] >= 0 && std::max(last.squares(cell), around_[cell]) * last.overlap <= allowed * allowed;
  }

  const CellGraph& grid_;
  const BandwidthRule& rule_;
  std::vector<double> width_;   // by cell
  std::vector<double> around_;  // by cell: density of squares; negative while nothing tells
  std::vector<std::uint32_t> open_;
};

}  // namespace

std::vector<float> chooseBandwidths(CellPyramid& pyramid, const CellLight& light, const BandwidthRule& rule) {
  const CellGraph& graph = pyramid.graph(0);
  ScaleSpace space(pyramid, light, kWidest);
  WidthSearch search(graph, rule);
  while (space.widen() && !search.judge(space.levels())) {
  }
  const double area = graph.meanArea(), narrowest = kNarrowest * std::sqrt(area);
  std::vector<float> logs;
  for (const double width : search.widths()) logs.push_back(static_cast<float>(std::log(std::max(width, narrowest))));
  // Choices are noisy too: their logarithms blend with their neighbours'.
  pyramid.evenFlow(0).apply(logs, 0.5 * kBlend * kBlend * area);
  for (float& l : logs) l = 0.5f * std::exp(2 * l);
  return logs;
}

}  // namespace deltalux
