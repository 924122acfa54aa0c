#include "paper/caustic_textures.hpp"

#include <algorithm>
#include <cmath>

#include "caustics/chart_part.hpp"
#include "caustics/restriction.hpp"
#include "caustics/surface_impacts.hpp"
#include "paper/spiral.hpp"
#include "paper/texture_resolution.hpp"

namespace deltalux::paper {

namespace {

using caustics::CellGrid;
using caustics::CellLight;
using caustics::ChartPart;
using caustics::Charts;
using caustics::ChartSurface;
using caustics::SurfaceCaustics;
using caustics::TexelBox;

void putTexture(SurfaceCaustics& result, const ChartSurface& surface, const ChartPart& part, int radius) {
  const CellGrid grid = surface.grid(part);
  if (grid.size() == 0) return;
  const CellLight light = collect(grid, part.impacts);
  result.textures.push_back(surface.texture(part, grid, light, reconstructSpiral(grid, light, radius)));
}

/// A texture for each lit region, and one for what is left. [GD01 3.3]
void putRestricted(SurfaceCaustics& result, const ChartSurface& surface, ChartPart& whole,
                   const TextureThresholds& rule) {
  const CellGrid grid = surface.grid(whole);
  const std::vector<Rgb> E = reconstructSpiral(grid, collect(grid, whole.impacts), rule.radius);
  const std::vector<TexelBox> boxes = markedBoxes(grid, litCells(E, rule.lit), 0);
  const std::vector<std::size_t> particles = particlesUnder(whole, grid, boxes);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (particles[i] < rule.leastParticles) continue;
    const glm::ivec2 texels =
        textureTexels(static_cast<double>(particles[i]), rule.variance, regionOf(grid, boxes[i]).size());
    putTexture(result, surface, surface.takeOut(whole, grid, boxes[i], texels), rule.radius);
  }
  putTexture(result, surface, whole, rule.radius);
}

/// The histogram of every chart [GD01 3.1 (1)]: its impacts in as many texels as all of them ask for [GD01 3.2]. None
/// for few particles.
std::vector<ChartPart> histograms(const Shape& shape, const Charts& charts, std::span<const particles::Impact> impacts,
                                  const TextureThresholds& rule) {
  if (impacts.size() < rule.leastParticles) return {};
  auto placed = placeImpacts(shape, charts, impacts);
  std::vector<ChartPart> parts(placed.size());
  for (std::uint32_t c = 0; c < placed.size(); ++c) {
    if (placed[c].empty()) continue;
    const ChartSurface surface(shape, charts, c);
    const double particles = static_cast<double>(placed[c].size());
    parts[c] = surface.whole(textureTexels(particles, rule.variance, surface.chart().size), std::move(placed[c]));
  }
  return parts;
}

/// Whether one of them varies by the threshold or more. [GD01 (3)]
bool uneven(const Shape& shape, const Charts& charts, const std::vector<ChartPart>& parts,
            const TextureThresholds& rule) {
  for (std::uint32_t c = 0; c < parts.size(); ++c)
    if (!parts[c].impacts.empty() &&
        contrast(collect(ChartSurface(shape, charts, c).grid(parts[c]), parts[c].impacts)) >= rule.contrast)
      return true;
  return false;
}

}  // namespace

double contrast(const CellLight& light) {
  if (light.gray.empty()) return 0;
  const auto [low, high] = std::minmax_element(light.gray.begin(), light.gray.end());
  return *high > 0 ? std::abs(*low - *high) / *high : 0.0;  // [GD01 (2)]
}

std::vector<char> litCells(const std::vector<Rgb>& E, double share) {
  float most = 0;
  for (const Rgb& e : E) most = std::max(most, gray(e));
  std::vector<char> lit;
  for (const Rgb& e : E) lit.push_back(gray(e) > 0 && gray(e) >= share * most);
  return lit;
}

bool deservesTextures(const Shape& shape, std::span<const particles::Impact> impacts, const TextureThresholds& rule) {
  const Charts charts = caustics::chartsOf(shape);
  return uneven(shape, charts, histograms(shape, charts, impacts, rule), rule);
}

std::optional<SurfaceCaustics> makeTextures(const Shape& shape, std::span<const particles::Impact> impacts,
                                            const TextureThresholds& rule) {
  SurfaceCaustics result;
  result.charts = caustics::chartsOf(shape);
  std::vector<ChartPart> parts = histograms(shape, result.charts, impacts, rule);
  if (!uneven(shape, result.charts, parts, rule)) return std::nullopt;
  for (std::uint32_t c = 0; c < parts.size(); ++c) {
    if (parts[c].impacts.empty()) continue;
    const ChartSurface surface(shape, result.charts, c);
    if (rule.restricted)
      putRestricted(result, surface, parts[c], rule);
    else
      putTexture(result, surface, parts[c], rule.radius);
  }
  return result;
}

caustics::TextureRule textureRule() {
  using Impacts = std::span<const particles::Impact>;
  using Settings = caustics::CausticSettings;
  return {[](const Shape& shape, Impacts impacts, const Settings&) { return deservesTextures(shape, impacts); },
          [](const Shape& shape, Impacts impacts, const Settings&) { return makeTextures(shape, impacts); }};
}

}  // namespace deltalux::paper
