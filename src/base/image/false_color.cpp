// False colour: illuminance on a logarithmic scale, in colours whose brightness rises with the value, so that the
// picture can be read without the legend and in print. Colours: cubehelix [Green11], start 0.5, -1.5 rotations,
// hue 1.2.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deltalux/image.hpp>
#include <deltalux/math.hpp>

#include "base/image/bitmap_font.hpp"

namespace deltalux {

namespace {
using Byte3 = std::array<std::uint8_t, 3>;
constexpr Byte3 kNoSurface{96, 96, 96}, kPaper{24, 24, 24}, kInk{235, 235, 235};  // [shown]

/// Colour for t in [0,1]; kept off pure black and white, which no value should look like.
Byte3 colorOf(double t) {
  const double lambda = 0.08 + 0.87 * std::clamp(t, 0.0, 1.0);
  const double phi = 2.0 * kPi * (0.5 / 3.0 + 1.0 - 1.5 * lambda);
  const double a = 1.2 * lambda * (1.0 - lambda) / 2.0;
  const auto channel = [&](double cosine, double sine) {  // [Green11 (2)]
    const double v = lambda + a * (cosine * std::cos(phi) + sine * std::sin(phi));
    return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(v, 0.0, 1.0)));
  };
  return {channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0.0)};
}

bool seesSurface(const Rgb& E) { return gray(E) >= 0.0f && std::isfinite(gray(E)); }

/// The smallest 1, 2 or 5 times a power of ten that is at least `lux`.
double roundUp(double lux) {
  const double decade = std::pow(10.0, std::floor(std::log10(lux)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * decade >= lux * (1.0 - 1e-9)) return step * decade;
  return 10.0 * decade;
}

double automaticTop(const Image& irradiance) {
  std::vector<double> values;
  for (const Rgb& E : irradiance.pixels)
    if (seesSurface(E) && gray(E) > 0.0f) values.push_back(photometric(glm::dvec3(E), irradiance.luminousEfficacy));
  if (values.empty()) return 1000.0;
  const auto rank = static_cast<std::ptrdiff_t>(0.995 * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return roundUp(values[static_cast<std::size_t>(rank)]);
}

/// "0.5", "20", "5k", "100k", "2M".
std::string luxLabel(double lux) {
  if (lux >= 999999.0) return fmt::format("{:.4g}M", lux / 1e6);
  if (lux >= 9999.0) return fmt::format("{:.4g}k", lux / 1e3);
  return fmt::format("{:.4g}", lux);
}

struct Scale {
  double top, decades;
  double position(double lux) const { return lux > 0.0 ? 1.0 + std::log10(lux / top) / decades : 0.0; }
};

/// 1, 2, 5 and their multiples by ten within the scale.
std::vector<double> ticksOf(const Scale& scale) {
  std::vector<double> ticks;
  const double lowest = scale.top / std::pow(10.0, scale.decades);
  for (int exponent = static_cast<int>(std::floor(std::log10(lowest))); ticks.size() < 64; ++exponent)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double lux = step * std::pow(10.0, exponent);
      if (lux > scale.top * (1.0 + 1e-9)) return ticks;
      if (lux >= lowest * (1.0 - 1e-9)) ticks.push_back(lux);
    }
  return ticks;
}

/// The legend's parts, in pixels; text doubles in size for pictures at least 600 pixels high.
struct Legend {
  int text, width, barLeft, barWidth, barTop, barHeight;
  explicit Legend(int height) {
    text = height >= 600 ? 2 : 1;
    barLeft = 4 * text;
    barWidth = 12 * text;
    width = barLeft + barWidth + 4 * text + kGlyphAdvance * 5 * text + 2 * text;
    barTop = (kGlyphHeight + 8) * text;
    barHeight = std::max(height - barTop - (kGlyphHeight / 2 + 3) * text, 1);
  }
  int row(double position) const { return barTop + static_cast<int>(std::lround((1.0 - position) * (barHeight - 1))); }
};

void drawLegend(DisplayImage& display, const Legend& legend, const Scale& scale) {
  drawText(display, legend.barLeft, 3 * legend.text, "lux", kInk, legend.text);
  for (int y = legend.barTop; y < std::min(legend.barTop + legend.barHeight, display.height); ++y) {
    const double position = 1.0 - static_cast<double>(y - legend.barTop) / std::max(legend.barHeight - 1, 1);
    for (int x = legend.barLeft; x < legend.barLeft + legend.barWidth; ++x) display.at(x, y) = colorOf(position);
  }
  int lastLabel = display.height + legend.barHeight;
  const std::vector<double> ticks = ticksOf(scale);
  for (const double lux : ticks) {  // upwards, leaving out labels that would touch the one below
    const int row = legend.row(scale.position(lux));
    if (lastLabel - row < (kGlyphHeight + 2) * legend.text || row >= display.height) continue;
    lastLabel = row;
    const int right = legend.barLeft + legend.barWidth;
    for (int x = right; x < right + 2 * legend.text; ++x) display.at(x, row) = kInk;
    drawText(display, right + 4 * legend.text, row - kGlyphHeight * legend.text / 2, luxLabel(lux), kInk, legend.text);
  }
}
}  // namespace

DisplayImage falseColor(const Image& irradiance, const FalseColorSettings& settings) {
  const Scale scale{settings.top > 0 ? settings.top : automaticTop(irradiance), settings.decades};
  const Legend legend(irradiance.height);
  DisplayImage display{irradiance.width + legend.width, irradiance.height, {}};
  display.pixels.assign(static_cast<std::size_t>(display.width) * display.height, kPaper);
  for (int y = 0; y < irradiance.height; ++y)
    for (int x = 0; x < irradiance.width; ++x) {
      const Rgb& E = irradiance.at(x, y);
      display.at(legend.width + x, y) =
          seesSurface(E) ? colorOf(scale.position(photometric(glm::dvec3(E), irradiance.luminousEfficacy)))
                         : kNoSurface;
    }
  drawLegend(display, legend, scale);
  return display;
}

}  // namespace deltalux
