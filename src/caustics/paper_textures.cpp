#include "caustics/paper_textures.hpp"

#include <algorithm>

#include "caustics/chart_part.hpp"
#include "caustics/choice.hpp"
#include "caustics/resolution.hpp"
#include "caustics/spiral.hpp"
#include "caustics/surface_impacts.hpp"

namespace deltalux::caustics {

namespace {

void put(SurfaceCaustics& result, const ChartSurface& surface, const ChartPart& part, int radius) {
  const CellGrid grid = surface.grid(part);
  if (grid.size() == 0) return;
  const CellLight light = collect(grid, part.impacts);
  result.textures.push_back(surface.texture(part, grid, light, reconstructSpiral(grid, light, radius)));
}

void putRestricted(SurfaceCaustics& result, const ChartSurface& surface, ChartPart& whole,
                   const PaperThresholds& rule) {
  const CellGrid grid = surface.grid(whole);
  const CellLight light = collect(grid, whole.impacts);
  for (const TexelBox& box : markedBoxes(grid, litCells(light.E, rule.lit), 0))
    put(result, surface, surface.takeOut(whole, grid, box, whole.texels), rule.radius);
  put(result, surface, whole, rule.radius);
}

}  // namespace

std::optional<SurfaceCaustics> makePaperTextures(const Shape& shape, std::span<const particles::Impact> impacts,
                                                 const PaperThresholds& rule) {
  if (impacts.size() < rule.leastParticles) return std::nullopt;  // [GD01 3.1]
  SurfaceCaustics result;
  result.charts = chartsOf(shape);
  auto placed = placeImpacts(shape, result.charts, impacts);
  std::vector<ChartPart> parts(placed.size());
  double V = 0;
  for (std::uint32_t c = 0; c < placed.size(); ++c) {
    if (placed[c].empty()) continue;
    const ChartSurface surface(shape, result.charts, c);
    const double particles = static_cast<double>(placed[c].size());
    parts[c] = surface.whole(paperTexels(particles, rule.variance, surface.chart().size), std::move(placed[c]));
    V = std::max(V, contrast(collect(surface.grid(parts[c]), parts[c].impacts)));
  }
  if (V < rule.contrast) return std::nullopt;  // [GD01 (3)]
  for (std::uint32_t c = 0; c < parts.size(); ++c) {
    if (parts[c].impacts.empty()) continue;
    const ChartSurface surface(shape, result.charts, c);
    if (rule.restricted)
      putRestricted(result, surface, parts[c], rule);
    else
      put(result, surface, parts[c], rule.radius);
  }
  return result;
}

}  // namespace deltalux::caustics
