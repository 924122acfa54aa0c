#include "caustics/cell_light.hpp"

#include <algorithm>

#include "base/check.hpp"

namespace deltalux {

CellLight collect(const CellGrid& grid, std::span<const ChartImpact> impacts) {
  CellLight light;
  std::vector<RgbSum> sums(grid.size(), RgbSum(0.0));
  std::vector<double> squares(grid.size(), 0.0);
  for (const ChartImpact& impact : impacts) {
    const std::uint32_t cell = grid.cellAt(impact.st);
    DELTALUX_CHECK(cell != CellGrid::kNone, "particles landed on a surface without area");
    const double g = gray(impact.flux);
    sums[cell] += RgbSum(impact.flux);
    squares[cell] += g * g;
    light.flux += RgbSum(impact.flux);
    light.squaredFlux += g * g;
  }
  light.particles = impacts.size();
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double area = grid.area(i);
    light.E.push_back(Rgb(sums[i] / area));  // [GD01 (1)]
    light.gray.push_back(gray(light.E.back()));
    light.squares.push_back(static_cast<float>(squares[i] / area));
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

double medianOfFlux(std::span<const float> areas, std::span<const float> E) {
  struct Cell {
    float E;
    double flux;
  };
  std::vector<Cell> cells(E.size());
  double wanted = 0;
  for (std::size_t i = 0; i < E.size(); ++i) cells[i] = {E[i], double(E[i]) * areas[i]}, wanted += cells[i].flux;
  wanted *= 0.5;
  // As when sorting, but only the part that holds the median is looked at again.
  auto begin = cells.begin(), end = cells.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Cell& a, const Cell& b) { return a.E < b.E; });
    double below = 0;
    for (auto c = begin; c != middle; ++c) below += c->flux;
    if (below >= wanted)
      end = middle;
    else
      wanted -= below, begin = middle;
  }
  return cells.empty() ? 0.0 : double(begin->E);
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

}  // namespace deltalux
