#pragma once
// How many texels? [GD01 3.2] The variance of a density estimate f from n particles with a kernel of half width h is
//   Var f <= K2 f / (n h^2)                                                                   (4)
// per unit of flux; with h half a texel, h = 2^-d / 2 (5), it stays within epsilon when 4 K2 2^2d / n <= epsilon (6),
// so
//   d <= ln(n epsilon / K2) / (2 ln 2) - 1.                                                     (7)
// The paper has one d; a surface that is longer than it is wide gets the same texels in all, as square as powers of two
// allow.
//
// Ours counts the particles where they are, not over the whole surface: texels shrink until those that the light falls
// on hold `perTexel` particles, and no further, because nothing finer can be told from noise (bandwidth.hpp). A wall
// with a small bright figure gets texels for the figure, and restriction (restriction.hpp) leaves the wall out.
#include "caustics/chart_part.hpp"

namespace deltalux::caustics {

/// Normalised box kernel in two dimensions: the integral of its square.
inline constexpr double kBoxKernel = 0.25;  // [defined]

/// d of (7), at least 0.
int paperResolution(double particles, double epsilon, double kernel = kBoxKernel);
/// Texels across and along (powers of two) of a region of `size`.
glm::ivec2 paperTexels(double particles, double epsilon, const glm::dvec2& size);

/// Square texels: how many across and along a region of `size` for texels of `area`, within `most`.
glm::ivec2 squareTexels(const glm::dvec2& size, double area, int most);

/// Area of a texel that holds `perTexel` particles where the part's light falls, as its present texels see it. [unit^2]
double texelArea(const ChartPart&, double perTexel);

}  // namespace deltalux::caustics
