#include "scene/form_factor.hpp"

#include <array>
#include <cmath>

namespace deltalux::scene {

double formFactorToPolygon(const Vec3f& x, const Vec3f& n, std::span<const Vec3f> polygon) {
  constexpr std::size_t kMax = 64;  // [limit]
  // In double precision: of a small polygon far away, what its edges bring cancels but for the last digits.
  const Vec3 normal(n);
  std::array<Vec3, 2 * kMax> clipped;
  std::size_t count = 0;
  const std::size_t size = std::min(polygon.size(), kMax);
  for (std::size_t i = 0; i < size; ++i) {
    const Vec3 a = Vec3(polygon[i]) - Vec3(x), b = Vec3(polygon[(i + 1) % size]) - Vec3(x);
    const double ha = glm::dot(a, normal), hb = glm::dot(b, normal);
    if (ha >= 0) clipped[count++] = a;
    if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0)) clipped[count++] = a + ha / (ha - hb) * (b - a);
  }
  if (count < 3) return 0.0;
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 &a = clipped[i], &b = clipped[(i + 1) % count], c = glm::cross(a, b);
    const double length = glm::length(c);
    if (length <= 0) continue;
    sum += std::atan2(length, glm::dot(a, b)) * (glm::dot(c, normal) / length);
  }
  return std::min(1.0, std::abs(sum) / (2 * kPi));
}

}  // namespace deltalux::scene
