#pragma once
#include "hierarchy/element.hpp"

namespace deltalux::paper {

/// What the rounding of coordinates may do to distances along `n` between two elements: along an axis, coordinates on
/// the others have no say, however large they are.
inline float roundingAlong(const Vec3f& n, const hierarchy::ElementGeometry& a, const hierarchy::ElementGeometry& b) {
  const Vec3f largest =
      glm::max(glm::max(glm::abs(a.lower), glm::abs(a.upper)), glm::max(glm::abs(b.lower), glm::abs(b.upper)));
  return 4e-6f * glm::dot(glm::abs(n), largest);
}

/// What it does to the height of a point above the plane of an element: a few units in the last place.
inline float roundingAlong(const Vec3f& n, const Vec3f& x, const hierarchy::ElementGeometry& g) {
  return 5e-7f * glm::dot(glm::abs(n), glm::max(glm::abs(x), glm::abs(g.center)));
}

}  // namespace deltalux::paper
