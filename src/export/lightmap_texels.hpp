#pragma once
// Which triangle of its chart each texel shows: the one under its centre, else the nearest.
//
// Texels whose centre no triangle covers, but that bilinear interpolation reads at the chart's border, carry on what
// the nearest triangle has, linearly and by no more than it varies over the triangle: surfaces that meet in one plane
// then show no seam. Triangles in the dark give way to lit ones nearby: where a wall stands on a floor, its foot does
// not darken the floor beside it.
#include <optional>
#include <vector>

#include "export/atlas_layout.hpp"

namespace deltalux::exporting {

struct LightmapTexel {
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]
  std::uint32_t triangle = kNone;                      // of the chart
  glm::vec2 weights{0.0f};                             // of its second and third corner, at the texel's centre
  glm::vec2 nearest{0.0f};                             // the same of the triangle's nearest point

  bool inside() const { return weights == nearest; }
};

/// Of the chart's rectangle and its gutter, row by row. `lit`: by triangle of the chart.
/// Cost: a distance per triangle and texel near it.
std::vector<LightmapTexel> texelsOf(const AtlasChart&, const ChartPlace&, int gutter, const std::vector<char>& lit);

/// What three corners have at a point of their triangle, or beyond it; not below 0.
Rgb carriedOn(const Rgb& a, const Rgb& b, const Rgb& c, const LightmapTexel&);
template <class T, class Weights>
T within(const T& a, const T& b, const T& c, const Weights& weights) {
  return a + weights.x * (b - a) + weights.y * (c - a);
}

/// Gives pixels that nobody knows the mean of known neighbours, gutter texels far; those beyond stay 0. `known` is by
/// pixel of `width` columns.
void dilate(std::vector<Rgb>& pixels, std::vector<char>& known, int width, int gutter);

}  // namespace deltalux::exporting
