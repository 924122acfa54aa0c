#include "caustics/scale_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "caustics/tuning.hpp"

namespace deltalux::caustics {

double kernelOverlap(double widthA, double widthB, double area) {
  return 1 / (2 * kPi * (widthA * widthA + widthB * widthB) + area);
}

ScaleSpace::ScaleSpace(const CellRaster& raster, const HeatFlow& even, Channels light)
    : flow_(even), area_(raster.meanArea()), limit_(tuning::kWidest * std::sqrt(area_)), levels_(1) {
  levels_[0] = {0.0, kernelOverlap(0, 0, area_), std::move(light)};
}

bool ScaleSpace::widen() {
  const ScaleLevel& last = levels_.back();
  const double width =  // each takes the light of twice the area
      last.width > 0 ? std::numbers::sqrt2 * last.width : tuning::kNarrowest * std::sqrt(area_);
  if (width > limit_) return false;
  ScaleLevel next{width, kernelOverlap(width, width, area_), last.light};
  flow_.apply(next.light, 0.5 * (width * width - last.width * last.width));
  levels_.push_back(std::move(next));
  return true;
}

}  // namespace deltalux::caustics
