#pragma once
// A rectangle of a chart, and the matrix that maps it to a texture's [0,1]^2. [GD01 6.2]
#include <deltalux/math.hpp>

namespace deltalux::caustics {

struct Region {
  Vec2 lower{0}, upper{1};  // on a closed chart s may run past the seam

  Vec2 size() const { return upper - lower; }
  bool contains(const Vec2& st) const {
    return st.x >= lower.x && st.x <= upper.x && st.y >= lower.y && st.y <= upper.y;
  }
  /// Chart coordinates (s,t,1) -> texture coordinates.
  glm::dmat3 toTexture() const {
    const Vec2 scale = 1.0 / size();
    return {scale.x, 0, 0, 0, scale.y, 0, -lower.x * scale.x, -lower.y * scale.y, 1};
  }
};

}  // namespace deltalux::caustics
