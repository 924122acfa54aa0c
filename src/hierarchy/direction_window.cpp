#include "hierarchy/direction_window.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::hierarchy {

DirectionWindow::DirectionWindow(const Elements& elements, const Scene& scene, ElementId distant, const Vec3& w,
                                 double angle) {
  constexpr double kMargin = 1e-3;  // [rounding]
  const PatchDomain& d = elements.domain[distant.index()];
  u0_ = d.u0, du_ = d.u1 - d.u0, v0_ = d.v0, dv_ = d.v1 - d.v0;
  const auto& emitter = scene[elements.light[distant.index()]].emitter;
  const auto* sun = std::get_if<SunLight>(&emitter);
  const auto* dome = std::get_if<DomeLight>(&emitter);
  const Vec3 axis = sun ? sun->direction : dome->axis;
  const double half = std::sin(0.5 * (sun ? sun->angularRadius : dome->halfAngle)), wide = angle + kMargin;
  const Vec3 local = Frame(axis).toLocal(w);
  const double from = std::acos(std::clamp(local.z, -1.0, 1.0));
  const auto shareAt = [&](double polar) {
    const double s = std::sin(0.5 * std::clamp(polar, 0.0, kPi));
    return s * s / (half * half);
  };
  lowV_ = shareAt(from - wide), highV_ = shareAt(from + wide);
  middleU_ = std::atan2(local.y, local.x) / (2 * kPi);
  if (from - wide > 0 && from + wide < kPi)
    halfU_ = std::asin(std::min(1.0, std::sin(wide) / std::sin(from))) / (2 * kPi) + kMargin;
}

}  // namespace deltalux::hierarchy
