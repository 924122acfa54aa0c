#include "caustics/scale_space.hpp"

#include <algorithm>

namespace deltalux {

namespace {
constexpr double kFirst = 0.5;         // in cells
constexpr double kWidestShare = 0.25;  // in the square root of the grid's area
constexpr double kPrecision = 1e-4;    // of estimates that are only compared
}  // namespace

double kernelOverlap(double widthA, double widthB, double area) {
  return 1 / (2 * kPi * (widthA * widthA + widthB * widthB) + area);
}

ScaleSpace::ScaleSpace(const CellGrid& grid, const CellLight& light, Openness open, double widest)
    : flow_(grid, std::vector<float>(grid.size(), 1.0f), open),
      area_(grid.meanArea()),
      limit_(std::min(widest * std::sqrt(area_), kWidestShare * std::sqrt(grid.totalArea()))),
      levels_(1) {
  levels_[0].overlap = kernelOverlap(0, 0, area_);
  for (std::size_t i = 0; i < grid.size(); ++i) levels_[0].light.push_back({light.gray[i], light.squares[i]});
}

bool ScaleSpace::widen() {
  const ScaleLevel& last = levels_.back();
  const double width = levels_.size() == 1 ? kFirst * std::sqrt(area_) : std::sqrt(2.0) * last.width;
  if (width > limit_) return false;
  ScaleLevel next{width, kernelOverlap(width, width, area_), last.light};
  flow_.apply(next.light, 0.5 * (width * width - last.width * last.width), kPrecision);
  levels_.push_back(std::move(next));
  return true;
}

}  // namespace deltalux
