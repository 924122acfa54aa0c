#include "caustics/bandwidth.hpp"

#include <algorithm>

#include "base/tuning.hpp"
#include "caustics/tuning.hpp"
#include "caustics/vector_math.hpp"

namespace deltalux::caustics {

namespace {

constexpr float kTiny = 1e-30f;      // [rounding]
constexpr std::size_t kChunk = 256;  // slots whose numbers stay close by [task]

/// What a level's kernel has in common with the narrower ones, for cells of one area.
struct Overlaps {
  std::vector<float> asked;   // E^2 / squares of a narrow kernel that expects enough particles
  std::vector<float> factor;  // of squares: the variance of the difference times kConfidence^2
  float own = 0;

  Overlaps(const std::vector<ScaleLevel>& levels, double meanArea, double cell) {
    const ScaleLevel& wide = levels.back();
    own = static_cast<float>(wide.overlap * meanArea);
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const double narrow = kernelOverlap(levels[k].width, levels[k].width, cell);
      const double both = kernelOverlap(levels[k].width, wide.width, meanArea);
      asked.push_back(static_cast<float>(tuning::kStray * narrow * meanArea));
      factor.push_back(static_cast<float>(tuning::kConfidence * tuning::kConfidence *
                                          (narrow + wide.overlap - 2 * both) * meanArea));
    }
  }
};

/// Widths are looked for level by level; few cells that want yet another are left with what there is.
class WidthSearch {
 public:
  WidthSearch(const CellRaster& raster, const BandwidthRule& rule)
      : raster_(raster),
        allowed_(static_cast<float>(tuning::kMatters * rule.error)),
        darkest_(static_cast<float>(rule.darkest)),
        log_(raster.slots(), static_cast<float>(std::log(tuning::kNarrowest))),
        noise_(raster.slots(), 0.0f),
        around_(raster.slots(), -1.0f),
        open_(raster.slots(), 0.0f) {
    const double cut = CellRaster::kWhole * raster.meanArea();
    for (std::size_t i = 0; i < raster.slots(); ++i) {
      if (raster.areas()[i] <= 0) continue;
      ++cells_;
      if (raster.cellAreas()[i] < cut)
        cut_.push_back(i);  // cells that an outline cuts are noisier than others
      else
        open_[i] = 1;
    }
  }

  /// Whether most cells are content with the last of these levels, or a narrower one.
  bool evaluate(const std::vector<ScaleLevel>& levels) {
    const auto log = static_cast<float>(std::log(levels.back().width / std::sqrt(raster_.meanArea())));
    const Overlaps whole(levels, raster_.meanArea(), raster_.meanArea());
    const std::size_t end = raster_.rowBegin(raster_.rows());
    std::size_t left = 0;
    for (std::size_t begin = raster_.rowBegin(0); begin < end; begin += kChunk)
      left += decide(levels, whole, log, begin, std::min(kChunk, end - begin));
    std::erase_if(cut_, [&](std::size_t i) {
      open_[i] = 1;
      const Overlaps cell(levels, raster_.meanArea(), raster_.cellAreas()[i]);
      const bool stays = decide(levels, cell, log, i, 1) > 0;
      open_[i] = 0;
      return !stays;
    });
    return static_cast<double>(left + cut_.size()) <= deltalux::tuning::kNegligible * static_cast<double>(cells_);
  }

  /// Logarithms of the widths in cells.
  Slots& logs() { return log_; }
  /// Variances of E that these widths leave.
  Slots& noise() { return noise_; }

 private:
  /// The width of the widest kernel that all narrower ones bear out. How many of the slots want a wider one.
  std::size_t decide(const std::vector<ScaleLevel>& levels, const Overlaps& overlaps, float log, std::size_t begin,
                     std::size_t count) {
    const float *light = levels.back().light[0].data() + begin, *square = levels.back().light[1].data() + begin;
    float E[kChunk], squares[kChunk], expected[kChunk], denied[kChunk];
    for (std::size_t i = 0; i < count; ++i) {
      E[i] = std::max(light[i], 0.0f), squares[i] = std::max(square[i], kTiny);
      expected[i] = E[i] * E[i] / squares[i], denied[i] = 0.0f;
    }
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
      const float asked = overlaps.asked[k], factor = overlaps.factor[k];
      const float* const narrow = levels[k].light[0].data() + begin;
      for (std::size_t i = 0; i < count; ++i) {
        const float d = E[i] - narrow[i];
        const float over = d * d > factor * squares[i] ? 1.0f : 0.0f;
        denied[i] = expected[i] >= asked ? std::max(denied[i], over) : denied[i];
      }
    }
    float *__restrict const width = log_.data() + begin, *__restrict const around = around_.data() + begin,
                           *__restrict const open = open_.data() + begin, *__restrict const rest = noise_.data() + begin;
    const float own = overlaps.own, enough = static_cast<float>(deltalux::tuning::kPilots) * own, allowed = allowed_,
                darkest = darkest_;
    float left = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float going = (1 - denied[i]) * open[i];
      width[i] = going > 0 ? log : width[i];
      // Where no particle fell, narrow kernels know no noise: the first that holds some tells.
      const float tells = expected[i] >= enough ? squares[i] : -1.0f, known = around[i] < 0 ? tells : around[i];
      around[i] = going > 0 ? known : around[i];
      const float limit = allowed * (E[i] + darkest), noise = std::max(squares[i], known) * own;
      rest[i] = going > 0 ? noise : rest[i];
      const float content = noise <= limit * limit ? 1.0f : 0.0f;
      open[i] = known < 0 ? going : (1 - content) * going;
    }
    for (std::size_t i = 0; i < count; ++i) left += open[i];
    return static_cast<std::size_t>(left);
  }

  const CellRaster& raster_;
  float allowed_, darkest_;
  Slots log_;                     // by slot: logarithm of the width
  Slots noise_;                   // by slot: variance of E at that width
  Slots around_;                  // by slot: density of squares; negative while nothing tells
  Slots open_;                    // by slot: 1 while it wants a wider kernel; not those cut by an outline
  std::vector<std::size_t> cut_;  // of those, which do
  std::size_t cells_ = 0;
};

}  // namespace

Bandwidths chooseBandwidths(const CellRaster& raster, const HeatFlow& even, const Channels& light,
                            const BandwidthRule& rule) {
  ScaleSpace space(raster, even, light);
  WidthSearch search(raster, rule);
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
