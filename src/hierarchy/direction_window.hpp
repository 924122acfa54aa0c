#pragma once
// Which points of a distant element's square lead in directions near a given one: a rectangle, found once, so that
// telling that of a point takes no sine. Conservative.
#include <cmath>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

class DirectionWindow {
 public:
  /// Of directions within `angle` (radians) of `w` (unit).
  DirectionWindow(const Elements&, const Scene&, ElementId distant, const Vec3& w, double angle);

  /// Never false when directionOf(a, b) is such a direction.
  bool holds(double a, double b) const {
    const double v = v0_ + b * dv_, u = u0_ + a * du_ - middleU_;
    return v >= lowV_ && v <= highV_ && std::abs(u - std::floor(u + 0.5)) <= halfU_;
  }

 private:
  double u0_, du_, v0_, dv_;  // the cell: turns around the axis, and shares of its dome
  double lowV_, highV_, middleU_, halfU_ = 0.5;
};

}  // namespace deltalux::hierarchy
