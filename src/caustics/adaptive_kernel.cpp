#include "caustics/adaptive_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "caustics/tuning.hpp"
#include "caustics/walls.hpp"

namespace deltalux::caustics {

namespace {

std::vector<float> channelOf(const CellLight& light, int channel) {
  std::vector<float> result(light.E.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = light.E[i][channel];
  return result;
}

std::vector<float> times(std::vector<float> values, float factor) {
  for (float& v : values) v *= factor;
  return values;
}

/// A grid's cells, and the flow that smooths its light.
class Smoothing {
 public:
  /// The mean E is 1 from here on, and so is the mean cell's area where noise is concerned.
  Smoothing(const CellGrid& grid, const CellLight& light, BandwidthRule rule)
      : raster_(grid), mean_(static_cast<float>(gray(light.flux) / grid.totalArea())) {
    if (!(mean_ > 0)) return;
    rule.darkest /= mean_;
    const Channels told{
        raster_.laidOut(times(light.gray, 1 / mean_)),
        raster_.laidOut(times(light.squares, static_cast<float>(1 / (grid.meanArea() * mean_ * mean_))))};
    Slots first = told[0];
    const EdgeStopping walls = blurredWalls(raster_, told);
    HeatFlow(raster_, walls.bandwidth, &walls.stopping).apply(first, 1.0);
    const double darkness = rule.error * (tuning::kMatters * medianOfFlux(raster_.areas(), first) + rule.darkest);
    const Borders stopping = sharpWalls(raster_, first, darkness);
    Bandwidths widths = chooseBandwidths(raster_, HeatFlow(raster_, {}, &stopping), told, rule);
    flow_.emplace(raster_, widths.conductivity, &stopping);
    noise_ = std::move(widths.noise);
  }

  /// By slot, of values by cell.
  Channels smoothed(std::span<const std::vector<float>> cells) const {
    Channels result;
    for (const std::vector<float>& values : cells) result.push_back(raster_.laidOut(values));
    if (flow_) flow_->apply(result, 1.0);
    return result;
  }

  /// Of a slot's value; what cancels there may be negative by a rounding.
  float at(const Channels& values, std::size_t channel, std::uint32_t cell) const {
    return std::max(values[channel][raster_.slotOf(cell)], 0.0f);
  }

  float noiseAt(std::uint32_t cell) const {
    return noise_.empty() ? 0.0f : mean_ * std::sqrt(std::max(noise_[raster_.slotOf(cell)], 0.0f));
  }

 private:
  CellRaster raster_;
  float mean_;
  Slots noise_;  // variance, of the light whose mean is 1
  std::optional<HeatFlow> flow_;
};

}  // namespace

AdaptiveEstimate reconstructAdaptive(const CellGrid& grid, const CellLight& light, const BandwidthRule& rule) {
  const Smoothing smoothing(grid, light, rule);
  const std::vector<float> cells[] = {channelOf(light, 0), channelOf(light, 1), channelOf(light, 2)};
  const Channels E = smoothing.smoothed(cells);
  AdaptiveEstimate result{std::vector<Rgb>(grid.size()), std::vector<float>(grid.size())};
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    for (int c = 0; c < 3; ++c) result.E[i][c] = smoothing.at(E, static_cast<std::size_t>(c), i);
    result.noise[i] = smoothing.noiseAt(i);
  }
  return result;
}

}  // namespace deltalux::caustics
