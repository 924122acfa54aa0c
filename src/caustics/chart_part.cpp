#include "caustics/chart_part.hpp"

#include "caustics/coverage.hpp"

namespace deltalux::caustics {

std::vector<std::size_t> particlesUnder(const ChartPart& part, const CellGrid& grid, std::span<const TexelBox> boxes) {
  std::vector<std::uint32_t> inTexel(part.areas.size(), 0);
  for (const ChartImpact& impact : part.impacts)
    if (const std::uint32_t texel = grid.texelNear(impact.st); texel != CellGrid::kNone) ++inTexel[texel];
  std::vector<std::size_t> under;
  for (const TexelBox& box : boxes) {
    std::size_t& sum = under.emplace_back(0);
    for (int y = box.y0; y < box.y1; ++y)
      for (int x = box.x0; x < box.x1; ++x)
        sum += inTexel[static_cast<std::size_t>(y) * grid.width() + x % grid.width()];
  }
  return under;
}

ChartPart ChartSurface::whole(glm::ivec2 texels, std::vector<ChartImpact> impacts) const {
  ChartPart part;
  part.region = {Vec2(0), chart().size};
  part.impacts = std::move(impacts);
  recut(part, texels);
  return part;
}

void ChartSurface::recut(ChartPart& part, glm::ivec2 texels) const {
  part.texels = texels;
  part.areas = coveredAreas(shape_, charts_, chart_, part.region, texels.x, texels.y);
}

bool ChartSurface::halve(ChartPart& part) const {
  const glm::ivec2 from = part.texels, to = (from + 1) / 2;
  if (chart().closed() && (from.x % 2 != 0 || from.y % 2 != 0)) return false;
  std::vector<float> areas(static_cast<std::size_t>(to.x) * to.y, 0.0f);
  for (int y = 0; y < from.y; ++y)
    for (int x = 0; x < from.x; ++x)
      areas[static_cast<std::size_t>(y / 2) * to.x + x / 2] += part.areas[static_cast<std::size_t>(y) * from.x + x];
  const Vec2 texel = part.region.size() / Vec2(from);
  part.region.upper = part.region.lower + 2.0 * texel * Vec2(to);
  part.texels = to;
  part.areas = std::move(areas);
  return true;
}

ChartPart ChartSurface::takeOut(ChartPart& from, const CellGrid& grid, const TexelBox& box, glm::ivec2 texels) const {
  const int width = from.texels.x;
  const auto inside = [&](std::size_t texel) {
    return holds(box, static_cast<int>(texel) % width, static_cast<int>(texel) / width, width);
  };
  ChartPart part;
  part.region = regionOf(grid, box);
  std::erase_if(from.impacts, [&](const ChartImpact& impact) {
    const std::uint32_t texel = grid.texelNear(impact.st);
    if (texel == CellGrid::kNone || !inside(texel)) return false;
    part.impacts.push_back(impact);
    // On a closed chart a box may run on over the seam.
    if (chart().closed() && impact.st.x < part.region.lower.x) part.impacts.back().st.x += chart().size.x;
    return true;
  });
  for (std::size_t i = 0; i < from.areas.size(); ++i)
    if (inside(i)) from.areas[i] = 0;
  recut(part, texels);
  return part;
}

CausticTexture ChartSurface::texture(const ChartPart& part, const CellGrid& grid, const CellLight& light,
                                     const std::vector<Rgb>& E) const {
  CausticTexture result = makeTexture(chart_, grid, part.areas, E);
  result.flux = light.flux;
  result.particles = light.particles;
  return result;
}

}  // namespace deltalux::caustics
