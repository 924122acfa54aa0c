#include "caustics/adaptive_kernel.hpp"

#include "caustics/walls.hpp"
#include "caustics/wide_flow.hpp"

namespace deltalux {

namespace {
constexpr double kPrecision = 1e-3;  // of light that only shows where edges are
constexpr double kMatters = 0.5;     // of what most of the light looks like: differences that are an edge
}  // namespace

std::vector<Rgb> reconstructAdaptive(const CellGrid& grid, const CellLight& light, const BandwidthRule& rule) {
  std::vector<float> first = light.gray;
  const Walls walls = blurredWalls(grid, light);
  HeatFlow(grid, walls.bandwidth, walls.openness).apply(first, 1.0, kPrecision);

  const double darkness = rule.error * (kMatters * medianOfFlux(grid, first) + rule.darkest);
  const std::vector<float> openness = sharpWalls(grid, first, darkness);
  CellPyramid pyramid(grid, openness);
  Channels channels(3, std::vector<float>(grid.size()));
  for (std::size_t i = 0; i < grid.size(); ++i)
    for (int c = 0; c < 3; ++c) channels[c][i] = light.E[i][c];
  flowWidely(pyramid, channels, chooseBandwidths(pyramid, light, rule));
  std::vector<Rgb> E(grid.size());
  for (std::size_t i = 0; i < grid.size(); ++i)  // the series' last digits may be negative
    for (int c = 0; c < 3; ++c) E[i][c] = std::max(channels[c][i], 0.0f);
  return E;
}

}  // namespace deltalux
