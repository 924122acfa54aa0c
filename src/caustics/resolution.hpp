#pragma once
// How many texels? The paper counts a surface's particles [GD01 3.2]: paper/texture_resolution.hpp.
//
// Ours counts the particles where they are, not over the whole surface: texels shrink until those that the light falls
// on hold `perTexel` particles, and no further, because nothing finer can be told from noise (bandwidth.hpp). A wall
// with a small bright figure gets texels for the figure, and restriction (restriction.hpp) leaves the wall out.
#include "caustics/chart_part.hpp"
#include "caustics/tuning.hpp"

namespace deltalux::caustics {

/// Texels across of a fine texture, at most: twice those of a coarse one.
inline constexpr int kFineSide = 2 * tuning::kCoarseSide;  // [defined]

/// Square texels: how many across and along a region of `size` for texels of `area`, within `most`.
glm::ivec2 squareTexels(const glm::dvec2& size, double area, int most);

/// Area of a texel that holds `perTexel` particles where the part's light falls, as its present texels see it. [unit^2]
double texelArea(const ChartPart&, double perTexel);

}  // namespace deltalux::caustics
