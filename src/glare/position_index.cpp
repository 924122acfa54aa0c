#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "glare/sight_frame.hpp"

namespace deltalux {

namespace glare {

SightFrame::SightFrame(const Eye& eye) {
  const double length = glm::length(eye.direction);
  DELTALUX_CHECK(length > 0, "an eye looks somewhere");
  ahead = eye.direction / length;
  const Vec3 aside = glm::cross(ahead, eye.up);
  constexpr double kParallel = 1e-9;  // [rounding]
  // Who looks straight up or down has no upright: any will do.
  right = glm::length(aside) > kParallel * glm::length(eye.up) ? glm::normalize(aside) : Frame(ahead).tangent;
  above = glm::cross(right, ahead);
}

}  // namespace glare

namespace {

constexpr double kDegrees = 180 / kPi;                               // [defined]
constexpr double kNearBelow = 0.6, kNearRise = 0.8, kFarRise = 1.2;  // of R / D, and of P over it [IT97] [defined]

/// tau: from the vertical through the line of sight; sigma: from the line of sight [degrees].
double aboveSight(double tau, double sigma) {
  return std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                  (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);  // [Guth63]
}

/// R / D: distance from the line of sight over the distance along it.
double belowSight(double slope) { return 1 + (slope < kNearBelow ? kNearRise : kFarRise) * slope; }  // [IT97]

}  // namespace

double positionIndex(const Eye& eye, const Vec3& towards) {
  const Vec3 d = glm::normalize(glare::SightFrame(eye).toLocal(towards));
  const double off = std::hypot(d.x, d.y);
  if (d.y < 0) return belowSight(off / std::max(d.z, 1e-9));
  return aboveSight(std::atan2(std::abs(d.x), d.y) * kDegrees, std::atan2(off, d.z) * kDegrees);
}

}  // namespace deltalux
