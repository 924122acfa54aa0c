#pragma once
#include <numbers>

namespace deltalux {

/// Cosine between triangles that are one smooth surface, sine of how far what stands on a surface may lean: they are
/// what they are nearer to, of flat and upright.
inline constexpr float kSmooth = std::numbers::sqrt2_v<float> / 2;  // [defined]

}  // namespace deltalux
