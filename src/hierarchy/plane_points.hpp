#pragma once
#include <algorithm>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// The inverse of PlaneFrame::at(): (u,v) of points of a plane, and of the feet of others on it. Finite also where the
/// plane's edges are parallel.
class PlanePoints {
 public:
  explicit PlanePoints(const PlaneFrame& f) : origin_(f.origin) {
    const Vec3 n = glm::cross(f.edgeU, f.edgeV);
    const double squared = std::max(glm::dot(n, n), 1e-300);
    dualU_ = glm::cross(f.edgeV, n) / squared, dualV_ = glm::cross(n, f.edgeU) / squared;
  }
  Vec2 of(const Vec3& p) const { return {glm::dot(p - origin_, dualU_), glm::dot(p - origin_, dualV_)}; }

 private:
  Vec3 origin_, dualU_, dualV_;
};

}  // namespace deltalux::hierarchy
