#pragma once
// The axes of an eye: right, up and the line of sight.
#include <deltalux/glare.hpp>

namespace deltalux::glare {

struct SightFrame {
  Vec3 right, above, ahead;  // unit, at right angles

  explicit SightFrame(const Eye&);
  /// Rightwards, upwards, ahead.
  Vec3 toLocal(const Vec3& v) const { return {glm::dot(v, right), glm::dot(v, above), glm::dot(v, ahead)}; }
};

/// L^2 omega / P^2: what a source adds to the sums.
inline double disturbance(const GlareSource& s) {
  return s.luminance * s.luminance * s.solidAngle / (s.positionIndex * s.positionIndex);
}

}  // namespace deltalux::glare
