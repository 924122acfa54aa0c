#pragma once
// GGX with Smith's height-correlated masking, sampled by visible normals.
// [WMLT07; Heitz14; DB23]
#include <deltalux/math.hpp>

#include "base/unit_circle.hpp"

namespace deltalux::scene::ggx {

/// Smith's Lambda: G1 = 1 / (1 + Lambda).
inline double lambda(double alpha, const Vec3& w) {
  const double tan2 = (1.0 - w.z * w.z) / (w.z * w.z);
  return 0.5 * (std::sqrt(1.0 + alpha * alpha * std::max(0.0, tan2)) - 1.0);
}

/// Distribution of unit normals h [1/sr].
inline double distribution(double alpha, const Vec3& h) {
  const double a2 = alpha * alpha;
  // 1 - z^2 from x and y: near the pole z^2 has lost the digits that matter.
  const double d = h.x * h.x + h.y * h.y + a2 * h.z * h.z;
  return a2 / (kPi * d * d);
}

/// f(wo, wi) for unit reflectance [1/sr]; both in the upper hemisphere.
inline double evaluate(double alpha, const Vec3& wo, const Vec3& wi) {
  const double D = distribution(alpha, glm::normalize(wo + wi));
  return D / ((1.0 + lambda(alpha, wo) + lambda(alpha, wi)) * 4.0 * wo.z * wi.z);
}

/// Density of sample() per solid angle of wi [1/sr].
inline double pdf(double alpha, const Vec3& wo, const Vec3& wi) {
  return distribution(alpha, glm::normalize(wo + wi)) / ((1.0 + lambda(alpha, wo)) * 4.0 * wo.z);
}

/// wi from two numbers in [0,1); may lie below the surface (z <= 0), where the lobe is zero.
inline Vec3 sample(double alpha, const Vec3& wo, const Vec2& u) {
  const Vec3 stretched = glm::normalize(Vec3(wo.x * alpha, wo.y * alpha, wo.z));
  const double z = (1.0 - u.x) * (1.0 + stretched.z) - stretched.z;  // a spherical cap [DB23]
  const double sinTheta = std::sqrt(std::max(0.0, 1.0 - z * z));
  const Vec3 m = Vec3(sinTheta * onUnitCircle(u.y), z) + stretched;
  const Vec3 h = glm::normalize(Vec3(m.x * alpha, m.y * alpha, m.z));
  return 2.0 * glm::dot(wo, h) * h - wo;
}

}  // namespace deltalux::scene::ggx
