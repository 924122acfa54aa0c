#include "radiosity/shaft.hpp"

namespace deltalux {

Shaft::Shaft(const ElementGeometry& a, const ElementGeometry& b)
    : lower_(glm::min(a.lower, b.lower)), upper_(glm::max(a.upper, b.upper)) {
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
      Plane& plane = planes_[static_cast<std::size_t>(count_++)];
      plane.normal = Vec3f(0.0f);
      plane.normal[i] = ni, plane.normal[j] = nj;
      plane.offset = std::max(ni * ai + nj * aj, ni * bi + nj * bj);
    }
  }
}

bool Shaft::meets(const Vec3f& lower, const Vec3f& upper) const {
  if (lower.x > upper_.x || lower.y > upper_.y || lower.z > upper_.z) return false;
  if (upper.x < lower_.x || upper.y < lower_.y || upper.z < lower_.z) return false;
  for (int k = 0; k < count_; ++k) {
    const Plane& p = planes_[static_cast<std::size_t>(k)];
    const Vec3f nearest{p.normal.x > 0 ? lower.x : upper.x, p.normal.y > 0 ? lower.y : upper.y,
                        p.normal.z > 0 ? lower.z : upper.z};
    if (glm::dot(p.normal, nearest) > p.offset) return false;
  }
  return true;
}

}  // namespace deltalux
