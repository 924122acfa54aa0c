#pragma once
// Functions over the sphere in real spherical harmonics up to order 2: what a cluster of Lambertian surfaces sends, and
// the irradiance that arrives at it as a function of the receiving normal. Both are sums of clamped cosines, of which
// order 2 keeps all but about 1 % of the energy [RH01]; and sums, so a cluster adds its
// children.
#include <array>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>

namespace deltalux::hierarchy {

inline constexpr int kHarmonics = 9;                     // [defined]
inline constexpr float kConstantHarmonic = 0.28209479f;  // [defined]

/// Values of the nine basis functions at the unit vector `w`.
inline std::array<float, kHarmonics> harmonics(const Vec3f& w) {
  constexpr float y0 = 0.28209479f, y1 = 0.48860251f, y2 = 1.09254843f, y20 = 0.31539157f, y22 = 0.54627422f;
  return {y0,
          y1 * w.y,
          y1 * w.z,
          y1 * w.x,
          y2 * w.x * w.y,
          y2 * w.y * w.z,
          y20 * (3.0f * w.z * w.z - 1.0f),
          y2 * w.x * w.z,
          y22 * (w.x * w.x - w.y * w.y)};
}

/// Convolution weights of the clamped cosine: pi, 2 pi / 3, pi / 4 for orders 0, 1, 2.
inline constexpr std::array<float, kHarmonics> kClampedCosine = {3.14159265f, 2.09439510f, 2.09439510f,
                                                                 2.09439510f, 0.78539816f, 0.78539816f,
                                                                 0.78539816f, 0.78539816f, 0.78539816f};  // [defined]

/// Mean of the basis functions over a set of normals: all that a patch's orientation means to a DirectionalRgb.
struct NormalMoments {
  std::array<float, kHarmonics> m{};
};

/// A sum of clamped cosines, per channel.
struct DirectionalRgb {
  std::array<Rgb, kHarmonics> c{};

  /// Adds amount * mean over the normals n of max(0, n . w), as a function of w.
  void addLobe(const NormalMoments& normals, const Rgb& amount) {
    for (int i = 0; i < kHarmonics; ++i) c[i] += kClampedCosine[i] * normals.m[i] * amount;
  }
  /// Adds amount * max(0, n . w) for the one direction n, as a function of w.
  void addLobe(const Vec3f& n, const Rgb& amount) { addLobe(NormalMoments{harmonics(n)}, amount); }
  /// Value at the direction `w`, not below zero.
  Rgb at(const Vec3f& w) const { return mean(NormalMoments{harmonics(w)}); }
  /// Mean value over a set of directions, not below zero.
  Rgb mean(const NormalMoments& directions) const {
    Rgb sum(0.0f);
    for (int i = 0; i < kHarmonics; ++i) sum += directions.m[i] * c[i];
    return glm::max(sum, Rgb(0.0f));
  }
  DirectionalRgb& operator+=(const DirectionalRgb& o) {
    for (int i = 0; i < kHarmonics; ++i) c[i] += o.c[i];
    return *this;
  }
};

}  // namespace deltalux::hierarchy
