#include "caustics/caustic_texture.hpp"

#include <algorithm>
#include <stdexcept>

namespace deltalux::caustics {

namespace {

constexpr double kFluxTolerance = 5e-3;  // [rounding]

/// The nearest copy of s around a closed chart from which the region runs on.
double unwrapped(double s, const Region& region, double turn) {
  if (s < region.lower.x) return s + turn * std::ceil((region.lower.x - s) / turn - 1e-12);
  if (s > region.upper.x) return s - turn * std::ceil((s - region.upper.x) / turn - 1e-12);
  return s;
}

Vec2 onRegion(Vec2 st, const CausticTexture& texture, const Chart& chart) {
  if (chart.closed()) st.x = unwrapped(st.x, texture.region, chart.size.x);
  return st;
}

}  // namespace

Rgb CausticTexture::sample(const Vec2& st) const {
  const Vec2 at = (st - region.lower) / region.size() * Vec2(width, height) - 0.5;
  const Vec2 corner = glm::floor(at), part = at - corner;
  const auto texelPast = [&](int x, int y) {
    if (y < 0 && poleAtStart) y = -1 - y, x += width / 2;
    if (y >= height && poleAtEnd) y = 2 * height - 1 - y, x += width / 2;
    x = closed ? (x % width + width) % width : std::clamp(x, 0, width - 1);
    return static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width + x;
  };
  Rgb sum(0.0f);
  double weights = 0;
  for (int k = 0; k < 4; ++k) {
    const int dx = k % 2, dy = k / 2;
    const std::size_t i = texelPast(static_cast<int>(corner.x) + dx, static_cast<int>(corner.y) + dy);
    if (!(areas[i] > 0) && isBlack(texels[i])) continue;
    const double w = (dx ? part.x : 1 - part.x) * (dy ? part.y : 1 - part.y);
    sum += static_cast<float>(w) * texels[i], weights += w;
  }
  return weights > 0 ? sum / static_cast<float>(weights) : Rgb(0.0f);
}

bool CausticTexture::shows(const Vec2& st, double turn) const {
  Vec2 at = st;
  if (turn > 0) at.x = unwrapped(at.x, region, turn);
  if (!region.contains(at)) return false;
  const Vec2 texel = (at - region.lower) / region.size() * Vec2(width, height);
  const int x = std::min(static_cast<int>(texel.x), width - 1), y = std::min(static_cast<int>(texel.y), height - 1);
  return areas[static_cast<std::size_t>(y) * width + x] > 0;
}

RgbSum CausticTexture::integral() const {
  RgbSum sum(0.0);
  for (std::size_t i = 0; i < texels.size(); ++i) sum += double(areas[i]) * RgbSum(texels[i]);
  return sum;
}

CausticTexture makeTexture(std::uint32_t chart, const CellGrid& grid, const std::vector<float>& texelAreas,
                           const std::vector<Rgb>& E) {
  CausticTexture texture;
  texture.chart = chart;
  texture.region = grid.region();
  texture.width = grid.width(), texture.height = grid.height();
  texture.closed = grid.closed();
  texture.poleAtStart = grid.poleAtStart(), texture.poleAtEnd = grid.poleAtEnd();
  texture.areas = texelAreas;
  for (std::size_t i = 0; i < texelAreas.size(); ++i)
    texture.texels.push_back(grid.cellOf(i) == CellGrid::kNone ? Rgb(0.0f) : E[grid.cellOf(i)]);
  return texture;
}

Rgb SurfaceCaustics::irradianceAt(const SurfacePoint& p) const {
  const std::size_t index = charts.indexOf(p.triangle);
  const Chart& chart = charts.all[index];
  const Vec2 st = chart.place(p);
  const double turn = chart.closed() ? chart.size.x : 0.0;
  const CausticTexture* nearest = nullptr;
  for (const CausticTexture& texture : textures) {
    if (texture.chart != index) continue;
    if (texture.shows(st, turn)) return texture.sample(onRegion(st, texture, chart));
    nearest = &texture;
  }
  // On an outline a point may fall just beyond all texels: the coarse texture comes last and is everywhere.
  if (!nearest) return Rgb(0.0f);
  const Vec2 at = onRegion(st, *nearest, chart);
  return nearest->sample(glm::clamp(at, nearest->region.lower, nearest->region.upper));
}

RgbSum SurfaceCaustics::flux() const {
  RgbSum sum(0.0);
  for (const CausticTexture& texture : textures) sum += texture.flux;
  return sum;
}

void validate(const CausticTexture& t) {
  const auto fail = [](const char* what) { throw std::logic_error(std::string("caustic texture: ") + what); };
  if (t.width < 1 || t.height < 1) fail("no texels");
  const std::size_t count = static_cast<std::size_t>(t.width) * t.height;
  if (t.texels.size() != count || t.areas.size() != count) fail("as many texels and areas as its size says");
  if (!(t.region.size().x > 0 && t.region.size().y > 0)) fail("an empty region");
  for (std::size_t i = 0; i < count; ++i) {
    if (!(t.areas[i] >= 0)) fail("a negative area");
    for (int c = 0; c < 3; ++c)
      if (!(t.texels[i][c] >= 0)) fail("negative irradiance");
  }
}

void validate(const SurfaceCaustics& s) {
  RgbSum shown(0.0);
  for (const CausticTexture& texture : s.textures) {
    if (texture.chart >= s.charts.all.size()) throw std::logic_error("caustic texture: on no chart of its surface");
    validate(texture);
    shown += texture.integral();
  }
  const RgbSum deposited = s.flux();
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(shown[c] - deposited[c]) <= kFluxTolerance * deposited[c] + 1e-12))
      throw std::logic_error("caustic textures: their integral is not the flux of the side's particles");
}

}  // namespace deltalux::caustics
