#include "panels/legend.hpp"

#include <imgui.h>

#include "panels/style.hpp"

namespace deltalux::viewer {

namespace {
constexpr int kSteps = 64;                             // of the drawn ramp
constexpr int kLinearParts = 10;                       // of a linear scale
constexpr float kBar = 18, kWidth = 92, kMargin = 14;  // [pixels at scale 1]

/// The colours of falseColor(), from the lowest to the highest.
std::vector<ImU32> ramp() {
  constexpr double kDecades = 3, kTop = 1000;
  Image gradient;
  gradient.width = kSteps, gradient.height = 1;
  for (int i = 0; i < kSteps; ++i) {
    const double lux = kTop * std::pow(10.0, kDecades * (double(i) / (kSteps - 1) - 1));
    gradient.pixels.emplace_back(float(lux / gradient.luminousEfficacy));
  }
  const DisplayImage shown = falseColor(gradient, {kTop, kDecades});
  std::vector<ImU32> colours;
  for (int i = 0; i < kSteps; ++i) {  // the picture is the right part of it, beside its own legend
    const auto c = shown.at(shown.width - kSteps + i, 0);
    colours.push_back(IM_COL32(c[0], c[1], c[2], 255));
  }
  return colours;
}

std::vector<LegendTick> logarithmicTicks(double top, double decades) {
  std::vector<LegendTick> ticks;
  const double lowest = top / std::pow(10.0, decades);
  const int first = int(std::floor(std::log10(lowest))), last = int(std::ceil(std::log10(top)));
  constexpr double kRounding = 1e-9;
  for (int exponent = first; exponent <= last; ++exponent)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * std::pow(10.0, exponent);
      const double position = 1 + std::log10(value / top) / decades;
      if (position >= -kRounding && position <= 1 + kRounding) ticks.push_back({position, value});
    }
  return ticks;
}
}  // namespace

std::vector<LegendTick> legendTicks(const FalseColour& f) {
  std::vector<LegendTick> ticks;
  if (f.useBands) {
    for (std::size_t i = 0; i < f.bands.size(); ++i)
      ticks.push_back({double(i + 1) / double(f.bands.size() + 1), f.bands[i]});
  } else if (f.logarithmic) {
    ticks = logarithmicTicks(f.top, f.decades);
  } else {
    for (int i = 0; i <= kLinearParts; ++i)
      ticks.push_back({double(i) / kLinearParts, f.top * double(i) / kLinearParts});
  }
  return ticks;
}

void drawLegend(const FalseColour& f, float pictureHeight, float bottom) {
  if (f.quantity == Quantity::Radiance) return;
  const float text = ImGui::GetFontSize(), scale = text / 15;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float height = std::clamp(0.55f * pictureHeight, 8 * text, 24 * text);
  const ImVec2 corner{kMargin * scale, pictureHeight - bottom - height - 3.2f * text};
  list.AddRectFilled(corner, {corner.x + kWidth * scale, corner.y + height + 2.6f * text}, IM_COL32(20, 21, 23, 220),
                     4);
  list.AddText({corner.x + 8 * scale, corner.y + 4 * scale}, IM_COL32(235, 235, 235, 255),
               f.quantity == Quantity::Luminance ? "cd/m\xc2\xb2" : "lx");
  const float left = corner.x + 8 * scale, low = corner.y + height + 1.9f * text;
  const auto up = [&](double position) { return low - height * float(position); };
  const std::vector<ImU32> colours = ramp();
  // In steps as the renderer has them: the colour of step i of n at i / n of the ramp.
  const int parts = f.useBands ? int(f.bands.size()) + 1 : kSteps;
  for (int i = 0; i < parts; ++i) {
    const double along = parts > 1 ? double(i) / (parts - 1) : 0;
    list.AddRectFilled({left, up(double(i + 1) / parts)}, {left + kBar * scale, up(double(i) / parts)},
                       colours[std::size_t(std::lround(along * (kSteps - 1)))]);
  }
  float lastAt = low + 2 * text;
  for (const LegendTick& tick : legendTicks(f)) {
    const float y = up(tick.position);
    if (lastAt - y < text) continue;  // no room for it
    lastAt = y;
    list.AddLine({left + kBar * scale, y}, {left + (kBar + 5) * scale, y}, IM_COL32(235, 235, 235, 255));
    list.AddText({left + (kBar + 9) * scale, y - 0.5f * text}, IM_COL32(235, 235, 235, 255),
                 fmt::format("{:.5g}", tick.value).c_str());
  }
}

}  // namespace deltalux::viewer
