#include "caustics/scale_space.hpp"

#include <algorithm>

namespace deltalux {

namespace {
constexpr double kFirst = 0.5;         // in cells
constexpr double kWidestShare = 0.25;  // in the square root of the grid's area
constexpr double kPrecision = 1e-4;    // of estimates that are only compared
constexpr double kWidestOnCells = 2;   // in cells of a level: wider kernels are made on coarser ones
constexpr double kRounding = 0.25;     // of a cell's area: time of the flow that rounds off what was spread to it
constexpr double kJoining = 0.25;      // of a cell's area: variance that joining four to one adds
}  // namespace

double kernelOverlap(double widthA, double widthB, double area) {
  return 1 / (2 * kPi * (widthA * widthA + widthB * widthB) + area);
}

ScaleSpace::ScaleSpace(CellPyramid& pyramid, const CellLight& light, double widest)
    : pyramid_(pyramid),
      area_(pyramid.graph(0).meanArea()),
      limit_(std::min(widest * std::sqrt(area_), kWidestShare * std::sqrt(pyramid.graph(0).totalArea()))),
      levels_(1),
      last_{light.gray, light.squares} {
  levels_[0].overlap = kernelOverlap(0, 0, area_);
  levels_[0].light = last_;
}

/// Variance that spreading from a level to the finest, and rounding off, adds.
double ScaleSpace::roundedOff(std::size_t level) const {
  double sum = 0;
  for (std::size_t l = 0; l < level; ++l) sum += 2 * kRounding * area_ * std::pow(4.0, l);
  return sum;
}

Channels ScaleSpace::onFinest(Channels light, std::size_t level) const {
  for (std::size_t l = level; l > 0; --l) {
    light = pyramid_.spread(light, l);
    pyramid_.evenFlow(l - 1).relax(light, kRounding * area_ * std::pow(4.0, l - 1));
  }
  return light;
}

/// All widths of a level of the pyramid at once.
void ScaleSpace::makeNext() {
  const double cell = std::sqrt(area_) * std::pow(2.0, level_), least = 1e-9 * cell;
  std::vector<double> widths, times;
  double width = ready_.empty() && levels_.size() == 1 ? kFirst * cell : std::sqrt(2.0) * levels_.back().width;
  for (; width <= limit_ && width <= kWidestOnCells * cell + least; width *= std::sqrt(2.0)) widths.push_back(width);
  if (widths.empty()) return;
  if (level_ > 0) {
    last_ = pyramid_.restricted(last_, level_);
    variance_ += kJoining * 0.25 * cell * cell;
  }
  for (const double w : widths) times.push_back(0.5 * (w * w - roundedOff(level_) - variance_));
  std::vector<Channels> made = pyramid_.evenFlow(level_).after(std::move(last_), times, kPrecision);
  variance_ = widths.back() * widths.back() - roundedOff(level_);
  last_ = made.back();
  for (std::size_t k = widths.size(); k-- > 0;)
    ready_.push_back({widths[k], kernelOverlap(widths[k], widths[k], area_), onFinest(std::move(made[k]), level_)});
  ++level_;
}

bool ScaleSpace::widen() {
  if (ready_.empty()) makeNext();
  if (ready_.empty()) return false;
  levels_.push_back(std::move(ready_.back()));
  ready_.pop_back();
  return true;
}

}  // namespace deltalux
