#pragma once
// Form factors in closed form.
#include <deltalux/math.hpp>
#include <span>

namespace deltalux::scene {

/// Fraction of the light leaving a small patch at `x` with unit normal `n` that reaches the planar polygon (world
/// vertices, at most 64, simple or weakly simple; either orientation), clipped to the hemisphere above the patch:
/// Lambert's boundary formula F = 1/(2 pi) sum_i angle_i n . (v_i x v_i+1) / |v_i x v_i+1|. Occlusion is not included.
double formFactorToPolygon(const Vec3f& x, const Vec3f& n, std::span<const Vec3f> polygon);

}  // namespace deltalux::scene
