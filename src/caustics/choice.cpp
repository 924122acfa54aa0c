#include "caustics/choice.hpp"

#include <algorithm>
#include <numeric>

#include "caustics/heat_flow.hpp"

namespace deltalux {

namespace {
constexpr double kCoarse = 1.0 / 8;      // of the surface's size: what a mesh of few patches can show
constexpr double kSignificance = 4;      // standard deviations
constexpr double kLeastExpected = 0.05;  // particles in a cell: variances of rarer events are not to be divided by
}  // namespace

double contrast(const CellLight& light) {
  if (light.gray.empty()) return 0;
  const auto [low, high] = std::minmax_element(light.gray.begin(), light.gray.end());
  return *high > 0 ? std::abs(*low - *high) / *high : 0.0;  // [GD01 (2)]
}

Departure& Departure::operator+=(const Departure& o) {
  chiSquare += o.chiSquare, cells += o.cells, variance += o.variance;
  squares += o.squares, flux += o.flux, area += o.area;
  return *this;
}

Departure departure(const CellGrid& grid, const CellLight& light) {
  Departure result;
  result.area = grid.totalArea(), result.flux = gray(light.flux);
  const double grain = light.grain();
  if (!(result.area > 0) || !(grain > 0)) return result;

  const CellRaster raster(grid);
  Slots smoothed = raster.laidOut(light.gray);
  const double reach = kCoarse * std::sqrt(result.area);
  HeatFlow(raster, {}).apply(smoothed, 0.5 * reach * reach);
  result.cells = static_cast<double>(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double area = grid.area(i), smooth = smoothed[raster.slotOf(static_cast<std::uint32_t>(i))];
    const double expected = std::max(smooth, kLeastExpected * grain / area), count = expected * area / grain;
    const double difference = light.gray[i] - smooth;
    result.chiSquare += difference * difference * area / (grain * expected);
    result.variance += 2 + 1 / count;
    result.squares += area * difference * difference - grain * std::max(smooth, 0.0);
  }
  return result;
}

Departure departureBetween(std::span<const double> flux, std::span<const double> area, double grain) {
  Departure result;
  const double mean = std::accumulate(flux.begin(), flux.end(), 0.0) / std::accumulate(area.begin(), area.end(), 0.0);
  for (std::size_t i = 0; i < flux.size() && mean > 0; ++i) {
    if (!(area[i] > 0)) continue;
    const double expected = mean * area[i], difference = flux[i] - expected;
    result.chiSquare += difference * difference / (grain * expected);
    result.cells += 1;
    result.variance += 2 + grain / expected;
    result.squares += difference * difference / area[i] - grain * mean;
  }
  return result;
}

bool deservesTexture(const Departure& d, double error, double background) {
  if (!(d.area > 0) || d.chiSquare <= d.cells + kSignificance * std::sqrt(d.variance)) return false;
  const double spread = std::sqrt(std::max(d.squares, 0.0) / d.area);
  return spread > error * (d.flux / d.area + background);
}

}  // namespace deltalux
