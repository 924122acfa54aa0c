#include "caustics/adaptive_kernel.hpp"

#include "caustics/walls.hpp"

namespace deltalux {

namespace {
constexpr double kPrecision = 1e-4;  // of light that only shows where edges are
constexpr double kMatters = 0.5;     // of what most of the light looks like: differences that are an edge
}  // namespace

std::vector<Rgb> reconstructAdaptive(const CellGrid& grid, const CellLight& light, const BandwidthRule& rule) {
  std::vector<float> first = light.gray;
  const Walls walls = blurredWalls(grid, light);
  HeatFlow(grid, walls.bandwidth, walls.openness).apply(first, 1.0, kPrecision);

  const double darkness = rule.error * (kMatters * medianOfFlux(grid, first) + rule.darkest);
  const std::vector<float> openness = sharpWalls(grid, first, darkness);
  std::vector<Rgb> E = light.E;
  HeatFlow(grid, chooseBandwidths(grid, light, openness, rule), openness).apply(E, 1.0);
  for (Rgb& value : E) value = glm::max(value, Rgb(0.0f));  // the series' last digits
  return E;
}

}  // namespace deltalux
