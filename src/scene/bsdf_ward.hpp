#pragma once
// Ward's isotropic lobe in the bounded form: reciprocal, albedo at most 1, and sampled by its own half vector with
// weights at most 2. This is the form Radiance uses for plastic and metal.
// [GMD10; Ward92]
#include <deltalux/math.hpp>

#include "base/unit_circle.hpp"

namespace deltalux::scene::ward {

/// f(wo, wi) for unit reflectance [1/sr]; both in the upper hemisphere.
inline double evaluate(double alpha, const Vec3& wo, const Vec3& wi) {
  const Vec3 h = wo + wi;  // not normalised
  const double hz2 = h.z * h.z, h2 = glm::dot(h, h);
  const double tan2 = (h2 - hz2) / hz2;
  return std::exp(-tan2 / (alpha * alpha)) * h2 / (kPi * alpha * alpha * hz2 * hz2);  // [GMD10 (17)]
}

/// Density of sample() per solid angle of wi [1/sr].
inline double pdf(double alpha, const Vec3& wo, const Vec3& wi) {
  const Vec3 h = wo + wi;
  const double h2 = glm::dot(h, h), hz2 = h.z * h.z;
  const double tan2 = (h2 - hz2) / hz2;
  const double cos2 = hz2 / h2, cos3 = cos2 * std::sqrt(cos2);
  const double half = std::exp(-tan2 / (alpha * alpha)) / (kPi * alpha * alpha * cos3);
  return half / (4.0 * glm::dot(wo, h) / std::sqrt(h2));
}

/// wi from two numbers in [0,1); may lie below the surface (z <= 0), where the lobe is zero.
inline Vec3 sample(double alpha, const Vec3& wo, const Vec2& u) {
  const double tan2 = -alpha * alpha * std::log(1.0 - u.x);
  const double cosTheta = 1.0 / std::sqrt(1.0 + tan2), sinTheta = std::sqrt(tan2) * cosTheta;
  const Vec3 h(sinTheta * onUnitCircle(u.y), cosTheta);
  return 2.0 * glm::dot(wo, h) * h - wo;
}

}  // namespace deltalux::scene::ward
