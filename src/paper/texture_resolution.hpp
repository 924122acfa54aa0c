#pragma once
// How many texels the paper gives a texture [GD01 3.2]. The variance of a density estimate f from n particles with a
// kernel of half width h is
//   Var f <= K2 f / (n h^2)                                                                   (4)
// per unit of flux; with h half a texel, h = 2^-d / 2 (5), it stays within epsilon when 4 K2 2^2d / n <= epsilon (6),
// so
//   d <= ln(n epsilon / K2) / (2 ln 2) - 1.                                                     (7)
// The paper has one d; a surface that is longer than it is wide gets the same texels in all, as square as powers of two
// allow.
#include <deltalux/math.hpp>

namespace deltalux::paper {

/// Normalised box kernel in two dimensions: the integral of its square.
inline constexpr double kBoxKernel = 0.25;  // [defined]

/// d of (7), at least 0.
int textureResolution(double particles, double epsilon, double kernel = kBoxKernel);
/// Texels across and along (powers of two) of a region of `size`.
glm::ivec2 textureTexels(double particles, double epsilon, const glm::dvec2& size);

}  // namespace deltalux::paper
