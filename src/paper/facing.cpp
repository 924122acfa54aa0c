#include "paper/facing.hpp"

#include <algorithm>
#include <cmath>

#include "paper/rounding.hpp"

namespace deltalux::paper {

bool turnsAway(const hierarchy::ElementGeometry& patch, const hierarchy::ElementGeometry& from) {
  const float cosine = patch.normalCone;
  if (!(cosine > 0)) return false;
  const float sine = std::sqrt(std::max(0.0f, 1 - cosine * cosine));
  const Vec3f& axis = patch.normal;
  // The greatest cosine of a direction of the cone with one whose cosine with the axis is c.
  const auto most = [&](float c) {
    return c >= cosine ? 1.0f : c * cosine + std::sqrt(std::max(0.0f, 1 - c * c)) * sine;
  };
  const Vec3f d = 0.5f * (from.lower + from.upper - patch.lower - patch.upper);
  const Vec3f half = 0.5f * (from.upper - from.lower + patch.upper - patch.lower);
  const float distance = glm::length(d);
  float reach = distance > 0 ? distance * most(glm::dot(axis, d) / distance) : 0.0f;
  for (int i = 0; i < 3; ++i) reach += half[i] * most(std::abs(axis[i]));
  return reach <= roundingAlong(axis, patch, from);
}

}  // namespace deltalux::paper
