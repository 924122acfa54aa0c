#include "caustics/scale_space.hpp"

#include <algorithm>

namespace deltalux {

namespace {
constexpr double kFirst = 0.5;         // in cells
constexpr double kWidest = 16;         // in cells
constexpr double kWidestShare = 0.25;  // in the square root of the grid's area
constexpr double kPrecision = 1e-4;    // of estimates that are only compared
}  // namespace

double kernelOverlap(double widthA, double widthB, double area) {
  return 1 / (2 * kPi * (widthA * widthA + widthB * widthB) + area);
}

std::vector<ScaleLevel> scaleSpace(const CellGrid& grid, const CellLight& light, Openness open) {
  const double area = grid.meanArea(), cell = std::sqrt(area);
  const double widest = std::min(kWidest * cell, kWidestShare * std::sqrt(grid.totalArea()));
  const HeatFlow flow(grid, std::vector<float>(grid.size(), 1.0f), open);
  std::vector<ScaleLevel> levels(1);
  levels[0].overlap = kernelOverlap(0, 0, area);
  for (std::size_t i = 0; i < grid.size(); ++i) levels[0].light.push_back({light.gray[i], light.squares[i]});
  for (double width = kFirst * cell; width <= widest; width *= std::sqrt(2.0)) {
    const ScaleLevel& last = levels.back();
    ScaleLevel next{width, kernelOverlap(width, width, area), last.light};
    flow.apply(next.light, 0.5 * (width * width - last.width * last.width), kPrecision);
    levels.push_back(std::move(next));
  }
  return levels;
}

}  // namespace deltalux
