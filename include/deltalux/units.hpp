#pragma once
// Radiometric quantities per RGB channel (linear, Radiance's default primaries) and their photometric reading.
#include <algorithm>
#include <glm/glm.hpp>

namespace deltalux {

using Rgb = glm::vec3;      // one linear value per channel, where the quantity is clear from the name
using RgbSum = glm::dvec3;  // accumulators

/// A quantity that cannot be mixed up with another; unwrap with .rgb inside kernels.
template <class Tag>
struct Radiometric {
  Rgb rgb{0.0f};

  Radiometric& operator+=(Radiometric o) { return rgb += o.rgb, *this; }
  Radiometric& operator-=(Radiometric o) { return rgb -= o.rgb, *this; }
  friend Radiometric operator+(Radiometric a, Radiometric b) { return {a.rgb + b.rgb}; }
  friend Radiometric operator-(Radiometric a, Radiometric b) { return {a.rgb - b.rgb}; }
  friend Radiometric operator*(float s, Radiometric a) { return {s * a.rgb}; }
  friend bool operator==(Radiometric a, Radiometric b) { return a.rgb == b.rgb; }
};
using Flux = Radiometric<struct FluxTag>;              // Phi [W]
using Irradiance = Radiometric<struct IrradianceTag>;  // E [W/m2]
using Radiosity = Radiometric<struct RadiosityTag>;    // B [W/m2]
using Radiance = Radiometric<struct RadianceTag>;      // L [W/(sr m2)]

/// Luminous efficacy of white light as Radiance defines it [lm/W]; other tools use 683. Scenes have their own.
inline constexpr double kLuminousEfficacy = 179.0;

/// Weights of the channels in luminance [Radiance, color.h: CIE_rf, CIE_gf, CIE_bf].
inline constexpr glm::dvec3 kLuminanceWeights{0.265, 0.670, 0.065};

/// Weighted sum of the channels, in the quantity's own radiometric unit.
inline double gray(const glm::dvec3& c) { return glm::dot(kLuminanceWeights, c); }
inline float gray(const Rgb& c) { return 0.265f * c.r + 0.670f * c.g + 0.065f * c.b; }

/// Irradiance [W/m2] to illuminance [lux], or radiance [W/(sr m2)] to luminance [cd/m2], by the efficacy of the scene
/// that it is of [lm/W].
inline double photometric(const glm::dvec3& radiometric, double luminousEfficacy) {
  return luminousEfficacy * gray(radiometric);
}

inline float maxChannel(const Rgb& c) { return std::max({c.r, c.g, c.b}); }
inline bool isBlack(const Rgb& c) { return c.r <= 0.0f && c.g <= 0.0f && c.b <= 0.0f; }

}  // namespace deltalux
