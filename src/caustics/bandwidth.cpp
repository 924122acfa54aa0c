#include "caustics/bandwidth.hpp"

#include <algorithm>
#include <limits>

#include "base/tuning.hpp"
#include "caustics/tuning.hpp"
#include "caustics/vector_math.hpp"

namespace deltalux::caustics {

namespace {

constexpr float kTiny = 1e-30f;                                // [rounding]
constexpr float kUnknown = std::numeric_limits<float>::max();  // error of what holds no particle

/// A kernel, and the one that its bias shows against.
struct Comparison {
  const ScaleLevel& wide;
  const ScaleLevel& narrow;  // two levels before, or the cells as they are

  explicit Comparison(const std::vector<ScaleLevel>& levels)
      : wide(levels.back()), narrow(levels[levels.size() - std::min<std::size_t>(3, levels.size())]) {}
};

/// Widths are looked for level by level; few cells that want yet another are left with what there is.
class WidthSearch {
 public:
  WidthSearch(const CellRaster& raster, const HeatFlow& even, const BandwidthRule& rule)
      : raster_(raster),
        even_(even),
        allowed_(static_cast<float>(tuning::kMatters * rule.error)),
        darkest_(static_cast<float>(rule.darkest)),
        log_(raster.slots(), static_cast<float>(std::log(tuning::kNarrowest))),
        noise_(raster.slots(), 0.0f),
        error_(raster.slots(), kUnknown),
        around_(raster.slots(), -1.0f),
        open_(raster.slots(), 0.0f) {
    for (std::size_t i = 0; i < raster.slots(); ++i)
      if (raster.areas()[i] > 0) open_[i] = 1, ++cells_;
  }

  /// Whether most cells are content with the last of these levels, or a narrower one.
  bool evaluate(const std::vector<ScaleLevel>& levels) {
    const Comparison compared(levels);
    const std::size_t left = decide(compared.wide, squaredBiases(compared));
    return static_cast<double>(left) <= deltalux::tuning::kNegligible * static_cast<double>(cells_);
  }

  /// Logarithms of the widths in cells.
  Slots& logs() { return log_; }
  /// Variances of E that these widths leave.
  Slots& noise() { return noise_; }

 private:
  /// Without bias themselves: squares of differences, less their variances. What one cell tells of it is noise; kernels
  /// as wide as the level between the two bring many together.
  Slots squaredBiases(const Comparison& c) const {
    const double area = raster_.meanArea();
    const double both = kernelOverlap(c.narrow.width, c.wide.width, area);
    Slots result(raster_.slots(), 0.0f);
    for (std::size_t i = 0; i < result.size(); ++i) {
      if (raster_.areas()[i] <= 0) continue;
      // Cells that an outline cuts are noisier than others.
      const double narrow = kernelOverlap(c.narrow.width, c.narrow.width, raster_.cellAreas()[i]);
      const float E = std::max(c.wide.light[0][i], 0.0f), squares = std::max(c.wide.light[1][i], kTiny);
      const float d = E - c.narrow.light[0][i];
      result[i] = d * d - static_cast<float>((narrow + c.wide.overlap - 2 * both) * area) * squares;
    }
    even_.apply(result, 0.25 * c.wide.width * c.wide.width);
    return result;
  }

  /// Keeps the width with the least error. How many of the slots want a wider one.
  std::size_t decide(const ScaleLevel& wide, const Slots& squaredBias) {
    const auto log = static_cast<float>(std::log(wide.width / std::sqrt(raster_.meanArea())));
    const auto own = static_cast<float>(wide.overlap * raster_.meanArea());
    const float enough = static_cast<float>(deltalux::tuning::kPilots) * own;
    float left = 0;
    for (std::size_t i = 0; i < open_.size(); ++i) {
      const float E = std::max(wide.light[0][i], 0.0f), squares = std::max(wide.light[1][i], kTiny), open = open_[i];
      // Where no particle fell, narrow kernels know no noise: the first that holds some tells.
      const float tells = E * E >= enough * squares ? squares : -1.0f, known = around_[i] < 0 ? tells : around_[i];
      around_[i] = open > 0 ? known : around_[i];
      const float noise = std::max(squares, known) * own, bias = std::max(squaredBias[i], 0.0f);
      const float error = known < 0 ? kUnknown : bias + noise;
      const float better = error <= error_[i] ? open : 0.0f;
      log_[i] = better > 0 ? log : log_[i];
      noise_[i] = better > 0 ? noise : noise_[i];
      error_[i] = better > 0 ? error : error_[i];
      // Bias grows with the width: above the least error by itself, no wider kernel has less.
      const float limit = allowed_ * (E + darkest_), content = known >= 0 && noise <= limit * limit ? 1.0f : 0.0f;
      open_[i] = bias <= error_[i] ? (1 - content) * open : 0.0f;
      left += open_[i];
    }
    return static_cast<std::size_t>(left);
  }

  const CellRaster& raster_;
  const HeatFlow& even_;
  float allowed_, darkest_;
  Slots log_;     // by slot: logarithm of the width
  Slots noise_;   // by slot: variance of E at that width
  Slots error_;   // by slot: mean squared error expected at that width
  Slots around_;  // by slot: density of squares; negative while nothing tells
  Slots open_;    // by slot: 1 while it wants a wider kernel
  std::size_t cells_ = 0;
};

}  // namespace

Bandwidths chooseBandwidths(const CellRaster& raster, const HeatFlow& even, const Channels& light,
                            const BandwidthRule& rule) {
  ScaleSpace space(raster, even, light);
  WidthSearch search(raster, even, rule);
  while (space.widen() && !search.evaluate(space.levels())) {
  }
  // Choices are noisy too: their logarithms blend with their neighbours'.
  Slots D = std::move(search.logs());
  raster.even(D);
  const double blend = 0.5 * tuning::kWidest;
  even.apply(D, 0.5 * blend * blend * raster.meanArea());
  const auto half = static_cast<float>(0.5 * raster.meanArea());
  for (float& d : D) d = half * expOf(2 * d);
  return {std::move(D), std::move(search.noise())};
}

}  // namespace deltalux::caustics
