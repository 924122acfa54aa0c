#include "paper/shaft.hpp"

#include <algorithm>
#include <limits>

namespace deltalux::paper {

Shaft::Shaft(const hierarchy::ElementGeometry& a, const hierarchy::ElementGeometry& b)
    : lower_(glm::min(a.lower, b.lower)), upper_(glm::max(a.upper, b.upper)) {
  offset_.fill(std::numeric_limits<float>::max());
  std::size_t count = 0;
  // Seen along each axis the boxes are two rectangles. A line through the same corner of both bounds their hull when
  // its outward normal points to that corner's quadrant.
  for (int axis = 0; axis < 3; ++axis) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    for (int corner = 0; corner < 4; ++corner) {
      const bool highI = corner & 1, highJ = corner & 2;
      const float ai = highI ? a.upper[i] : a.lower[i], aj = highJ ? a.upper[j] : a.lower[j];
      const float bi = highI ? b.upper[i] : b.lower[i], bj = highJ ? b.upper[j] : b.lower[j];
      float ni = bj - aj, nj = ai - bi;
      const float si = highI ? 1.0f : -1.0f, sj = highJ ? 1.0f : -1.0f;
      if (ni * si < 0 || nj * sj < 0) ni = -ni, nj = -nj;
      if (ni * si <= 0 || nj * sj <= 0) continue;
      const auto setNormal = [&](int along, float n) {
        positive_[along][count] = std::max(n, 0.0f), negative_[along][count] = std::min(n, 0.0f);
      };
      setNormal(i, ni), setNormal(j, nj);
      offset_[count++] = std::max(ni * ai + nj * aj, ni * bi + nj * bj);
    }
  }
}

bool Shaft::meets(const Vec3f& lower, const Vec3f& upper) const {
  if (lower.x > upper_.x || lower.y > upper_.y || lower.z > upper_.z) return false;
  if (upper.x < lower_.x || upper.y < lower_.y || upper.z < lower_.z) return false;
  int beyond = 0;
  for (std::size_t k = 0; k < kLanes; ++k) {
    float nearest = 0;
    for (int axis = 0; axis < 3; ++axis) nearest += positive_[axis][k] * lower[axis] + negative_[axis][k] * upper[axis];
    beyond |= nearest > offset_[k];
  }
  return beyond == 0;
}

}  // namespace deltalux::paper
