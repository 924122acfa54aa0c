#include "caustics/low_frequency_layer.hpp"

#include <algorithm>
#include <cmath>

#include "caustics/tuning.hpp"

namespace deltalux::caustics {

namespace {

Vec2 centreOf(const Region& region, int width, int height, int x, int y) {
  return region.lower + region.size() / Vec2(width, height) * Vec2(x + 0.5, y + 0.5);
}

double smoothStep(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

FadingBorder::FadingBorder(const CellGrid& whole, const TexelBox& b, int margin)
    : box(regionOf(whole, b)), width(double(margin) * whole.texelSize()) {
  const bool round = whole.closed() && b.x1 - b.x0 >= whole.width();
  left = whole.closed() ? !round : b.x0 > 0;
  right = whole.closed() ? !round : b.x1 < whole.width();
  below = b.y0 > 0, above = b.y1 < whole.height();
  within = {b.x0 + left * margin, b.y0 + below * margin, b.x1 - right * margin, b.y1 - above * margin};
}

double FadingBorder::at(const Vec2& st) const {
  double inside = 1;
  if (left) inside = std::min(inside, (st.x - box.lower.x) / width.x);
  if (right) inside = std::min(inside, (box.upper.x - st.x) / width.x);
  if (below) inside = std::min(inside, (st.y - box.lower.y) / width.y);
  if (above) inside = std::min(inside, (box.upper.y - st.y) / width.y);
  return 1 - smoothStep(inside);
}

LowFrequencyLayer::LowFrequencyLayer(const ChartSurface& surface, ChartPart all, const CellGrid& grid,
                                     const AdaptiveEstimate& reconstruction, std::span<const FadingBorder> borders,
                                     int halvings)
    : all_(surface.texture(all, grid, {}, reconstruction.E)) {
  std::vector<ChartImpact> pieces;
  for (int y = 0; y < all_.height; ++y)
    for (int x = 0; x < all_.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * all_.width + x;
      const auto hides = [&](const FadingBorder& b) { return holds(b.within, x, y, all_.width); };
      if (std::any_of(borders.begin(), borders.end(), hides)) all.areas[i] = 0;
      if (all.areas[i] > 0)
        pieces.push_back({centreOf(all_.region, all_.width, all_.height, x, y), all.areas[i] * all_.texels[i]});
    }
  for (int i = 0; i < halvings; ++i) surface.halve(all);
  const CellGrid halved = surface.grid(all);
  shown_ = surface.texture(all, halved, {}, collect(halved, pieces).E);
}

void LowFrequencyLayer::over(const CellGrid& grid, const FadingBorder& border, const BandwidthRule& rule,
                             AdaptiveEstimate& own) const {
  for (std::uint32_t i = 0; i < grid.size(); ++i) {
    const auto texel = static_cast<int>(grid.texelOf(i));
    const Vec2 st = centreOf(grid.region(), grid.width(), grid.height(), texel % grid.width(), texel / grid.width());
    Rgb& E = own.E[i];
    const Rgb layer = all_.sample(st);
    const double difference = gray(layer) - gray(E), noise = std::max<double>(own.noise[i], 1e-30);
    const double allowed = rule.error * (gray(E) + rule.darkest);
    const double asked = smoothStep(noise / std::max(tuning::kMatters * allowed, 1e-30));
    const double bearsOut = std::exp(-std::pow(difference / noise, 2));
    E += static_cast<float>(asked * bearsOut) * (layer - E);
    if (const double fades = border.at(st); fades > 0) E += static_cast<float>(fades) * (shown_.sample(st) - E);
  }
}

CausticTexture LowFrequencyLayer::shownOn(const ChartPart& left) const {
  CausticTexture shown = shown_;
  shown.areas = left.areas;
  shown.flux = RgbSum(0.0);
  for (const ChartImpact& impact : left.impacts) shown.flux += RgbSum(impact.flux);
  shown.particles = left.impacts.size();
  return shown;
}

}  // namespace deltalux::caustics
