#pragma once
// Triangles seen from a point: their solid angle, and directions uniform in it.
// [OS83; Arvo95]
#include <algorithm>
#include <deltalux/math.hpp>

namespace deltalux::scene {

/// Solid angle of the triangle of unit directions a, b, c [sr], in [0, 2 pi].
inline double sphericalTriangleArea(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  return 2.0 * std::atan2(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));  // [OS83 (8)]
}

/// A direction uniform in the triangle of unit directions a, b, c from two numbers in [0,1).
inline Vec3 sampleSphericalTriangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec2& u) {
  const auto orthogonal = [](const Vec3& x, const Vec3& y) {  // the unit part of x at right angles to y
    const Vec3 part = x - glm::dot(x, y) * y;
    const double length = glm::length(part);
    return length > 0.0 ? part / length : Frame(y).tangent;
  };
  const double cosAlpha = glm::dot(orthogonal(b, a), orthogonal(c, a));
  const double alpha = std::acos(std::clamp(cosAlpha, -1.0, 1.0)), sinAlpha = std::sin(alpha);
  const double part = u.x * sphericalTriangleArea(a, b, c);
  const double s = std::sin(part - alpha), t = std::cos(part - alpha);
  const double p = t - std::cos(alpha), r = s + sinAlpha * glm::dot(a, b);
  const double q = ((r * t - p * s) * std::cos(alpha) - r) / ((r * s + p * t) * sinAlpha);
  const double cosB = std::clamp(std::isfinite(q) ? q : 1.0, -1.0, 1.0);
  const Vec3 onEdge = cosB * a + std::sqrt(1.0 - cosB * cosB) * orthogonal(c, a);
  const double z = 1.0 - u.y * (1.0 - glm::dot(onEdge, b));
  return glm::normalize(z * b + std::sqrt(std::max(0.0, 1.0 - z * z)) * orthogonal(onEdge, b));
}

}  // namespace deltalux::scene
