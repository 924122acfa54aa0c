#include "caustics/cell_light.hpp"

#include <algorithm>
#include <bit>

#include "base/check.hpp"

namespace deltalux::caustics {

CellLight collect(const CellGrid& grid, std::span<const ChartImpact> impacts) {
  CellLight light;
  std::vector<RgbSum> sums(grid.size(), RgbSum(0.0));
  std::vector<double> squares(grid.size(), 0.0);
  light.fourths.assign(grid.size(), 0.0);
  for (const ChartImpact& impact : impacts) {
    const std::uint32_t cell = grid.cellAt(impact.st);
    DELTALUX_CHECK(cell != CellGrid::kNone, "particles deposited on a surface without area");
    const double g = gray(impact.flux);
    sums[cell] += RgbSum(impact.flux);
    squares[cell] += g * g;
    light.fourths[cell] += g * g * g * g;
    light.flux += RgbSum(impact.flux);
    light.squaredFlux += g * g;
  }
  light.particles = impacts.size();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double area = grid.area(i);
    light.E.push_back(Rgb(sums[i] / area));  // [GD01 (1)]
    light.gray.push_back(gray(light.E.back()));
    light.squares.push_back(static_cast<float>(squares[i] / area));
    light.fourths[i] /= area;
  }
  return light;
}

double typicalIrradiance(std::span<const double> flux, std::span<const double> squares, std::span<const float> areas) {
  double pairs = 0, total = 0, whole = 0;
  for (std::size_t i = 0; i < flux.size(); ++i) {
    total += flux[i];
    if (!(areas[i] > 0)) continue;
    pairs += (flux[i] * flux[i] - squares[i]) / areas[i];
    whole += areas[i];
  }
  return total > 0 && whole > 0 ? std::max(pairs / total, total / whole) : 0.0;
}

double weightedMedian(std::span<const float> values, std::span<const float> weights) {
  // Values that are not negative are ordered as their bits are: first of all by the leading ones.
  constexpr int kept = 20;
  std::vector<double> sums(std::size_t{1} << (31 - kept), 0.0);
  const auto binOf = [](float v) { return std::bit_cast<std::uint32_t>(std::max(v, 0.0f)) >> kept; };
  for (std::size_t i = 0; i < values.size(); ++i) sums[binOf(values[i])] += weights[i];
  double wanted = 0;
  for (const double sum : sums) wanted += 0.5 * sum;
  std::size_t bin = 0;
  while (bin + 1 < sums.size() && !(sums[bin] >= wanted)) wanted -= sums[bin++];
  std::vector<std::pair<float, float>> within;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (binOf(values[i]) == bin && weights[i] > 0) within.emplace_back(values[i], weights[i]);
  std::sort(within.begin(), within.end());
  double below = 0;
  for (const auto& [value, weight] : within)
    if ((below += weight) >= wanted) return value;
  return within.empty() ? 0.0 : within.back().first;
}

double medianOfFlux(std::span<const float> areas, std::span<const float> E) {
  std::vector<float> flux(E.size());
  for (std::size_t i = 0; i < E.size(); ++i) flux[i] = std::max(E[i], 0.0f) * areas[i];
  return weightedMedian(E, flux);
}

std::vector<float> grayOf(const std::vector<Rgb>& E) {
  std::vector<float> result;
  result.reserve(E.size());
  for (const Rgb& e : E) result.push_back(gray(e));
  return result;
}

double typicalIrradiance(const CellGrid& grid, const CellLight& light) {
  std::vector<double> flux, squares;
  std::vector<float> areas;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    areas.push_back(grid.area(i));
    flux.push_back(double(light.gray[i]) * grid.area(i));
    squares.push_back(double(light.squares[i]) * grid.area(i));
  }
  return typicalIrradiance(flux, squares, areas);
}

}  // namespace deltalux::caustics
