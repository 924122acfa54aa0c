#include "walk.hpp"

#include "camera.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kEase = 0.08;   // time in which a speed comes near what is asked for [s]
constexpr double kStill = 0.01;  // of the speed, below which one stands
constexpr double kFast = 4;      // times the speed
constexpr double kMetres = 1.5;  // a person's speed [m / s]
constexpr double kCrossing = 4;  // least time from end to end of a scene [s]
}  // namespace

bool Walk::advance(View& view, const Steps& steps, bool level, double speed, double seconds) {
  const Vec3 target = (steps.fast ? kFast : 1) * steps.rightForwardUp;
  // The way is the integral of an exponential approach: the same for one long frame and for many short ones.
  const double rest = std::exp(-seconds / kEase);
  const Vec3 way = seconds * target + kEase * (1 - rest) * (velocity_ - target);
  velocity_ = target + rest * (velocity_ - target);
  moving_ = glm::length(velocity_) > kStill || glm::length(target) > 0;
  if (!moving_) velocity_ = Vec3(0);
  if (glm::length(way) == 0) return false;
  move(view, speed * way, level);
  return true;
}

double walkingSpeed(const Scene& scene) {
  const double person = kMetres / scene.metresPerUnit, diagonal = bounds(scene).diagonal();
  return diagonal > 0 ? std::min(person, diagonal / kCrossing) : person;
}

}  // namespace deltalux::viewer
