#include <algorithm>
#include <cmath>
#include <deltalux/material.hpp>

namespace deltalux {

namespace {

constexpr double kLeastCosine = 1e-4;  // of a flat source seen so nearly edge-on that rounding makes it [rounding]

/// Radiance's rule inside the cone: the inverse square counts from a focus behind the source. [Radiance, spotlight]
double relativeRadiance(const SpotCone& spot, const Vec3& direction, double distance) {
  const double focal = glm::length(spot.direction);
  const double along = glm::dot(direction, spot.direction);
  if (along < 0 && spot.fullAngle < kPi) return 0.0;
  if (along < std::cos(0.5 * spot.fullAngle) * focal) return 0.0;
  const double ratio = distance / (distance + focal);
  return ratio * ratio;
}

}  // namespace

double relativeRadiance(const EmissionPattern& pattern, const Vec3& direction) {
  const double value = pattern.scale * valueAt(*pattern.table, glm::transpose(pattern.frame) * direction);
  if (!pattern.normal) return value;
  return value / std::max(std::abs(glm::dot(direction, *pattern.normal)), kLeastCosine);
}

double relativeRadiance(const Emission& emission, const Vec3& direction, double distance) {
  double result = 1;
  if (emission.spot) result *= relativeRadiance(*emission.spot, direction, distance);
  if (emission.pattern) result *= relativeRadiance(*emission.pattern, direction);
  return result;
}

void turn(Emission& emission, const glm::dmat3& by) {
  if (emission.spot) emission.spot->direction = by * emission.spot->direction;
  if (!emission.pattern) return;
  const auto turned = [&](const Vec3& v) {
    const Vec3 to = by * v;
    return to == v ? v : glm::normalize(to);
  };
  for (int axis = 0; axis < 3; ++axis) emission.pattern->frame[axis] = turned(emission.pattern->frame[axis]);
  if (emission.pattern->normal) emission.pattern->normal = turned(*emission.pattern->normal);
}

}  // namespace deltalux
