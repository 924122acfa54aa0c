#include "panels/legend.hpp"

#include <imgui.h>

#include <algorithm>

#include "false_colour.hpp"

namespace deltalux::viewer {

namespace {
constexpr int kSteps = 64;                             // of a ramp as it is drawn
constexpr float kBar = 18, kWidth = 92, kMargin = 14;  // [pixels at scale 1]

ImU32 screenColour(const glm::vec3& c) { return ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1}); }
}  // namespace

std::vector<LegendTick> legendTicks(const FalseColour& f) {
  const std::vector<double> levels = scaleLevels(f);
  std::vector<LegendTick> ticks;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double between = double(i + 1) / double(levels.size() + 1);  // steps are of one height
    ticks.push_back({hasBands(f) ? between : scalePosition(f, levels[i]), levels[i]});
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
  const std::vector<LegendTick> ticks = legendTicks(f);
  const int parts = hasBands(f) ? int(ticks.size()) + 1 : kSteps;
  for (int i = 0; i < parts; ++i)
    list.AddRectFilled({left, up(double(i + 1) / parts)}, {left + kBar * scale, up(double(i) / parts)},
                       screenColour(rampColour(double(i) / std::max(parts - 1, 1))));
  float lastAt = low + 2 * text;
  for (const LegendTick& tick : ticks) {
    const float y = up(tick.position);
    if (lastAt - y < text) continue;  // no room for it
    lastAt = y;
    list.AddLine({left + kBar * scale, y}, {left + (kBar + 5) * scale, y}, IM_COL32(235, 235, 235, 255));
    list.AddText({left + (kBar + 9) * scale, y - 0.5f * text}, IM_COL32(235, 235, 235, 255),
                 fmt::format("{:.5g}", tick.value).c_str());
  }
}

}  // namespace deltalux::viewer
