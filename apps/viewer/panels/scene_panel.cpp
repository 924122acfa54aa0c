#include "panels/scene_panel.hpp"

#include <imgui.h>

#include "panels/widgets.hpp"

namespace deltalux::viewer {

void viewPanel(Controller& controller, Tools& tools) {
  for (int slot = 1; slot <= 9; ++slot) {
    if (slot > 1) ImGui::SameLine();
    const std::string label = std::to_string(slot);
    if (ImGui::SmallButton(label.c_str())) {
      if (ImGui::GetIO().KeyCtrl)
        controller.bookmark(slot);
      else
        controller.goToBookmark(slot);
    }
  }
  quietText("Bookmarks; with Ctrl the present view is kept.");
  bool fly = !tools.level;
  if (ImGui::Checkbox("Fly where you look (Space)", &fly)) tools.level = !fly;
}

void sectionPanel(Controller& controller) {
  std::optional<Box>& section = controller.draw().section;
  const Box whole = bounds(controller.scene());
  bool cut = section.has_value();
  if (ImGui::Checkbox("Cut away what lies outside", &cut)) section = cut ? std::optional(whole) : std::nullopt;
  if (!section || whole.empty()) return;
  constexpr const char* kLabels[3][2] = {{"x from", "x to"}, {"y from", "y to"}, {"z from", "z to"}};
  const double metres = controller.scene().metresPerUnit;
  for (int i = 0; i < 3; ++i) {  // in metres from the scene's own corner
    const double extent = metres * whole.extent()[i];
    double from = metres * (section->lower[i] - whole.lower[i]), to = metres * (section->upper[i] - whole.lower[i]);
    if (slider(kLabels[i][0], from, 0, extent, "%.2f m")) from = std::min(from, to);
    if (slider(kLabels[i][1], to, 0, extent, "%.2f m")) to = std::max(from, to);
    section->lower[i] = whole.lower[i] + from / metres, section->upper[i] = whole.lower[i] + to / metres;
  }
}

void overlayPanel(Controller& controller) {
  DrawSettings& draw = controller.draw();
  ImGui::Checkbox("Mesh (M)", &draw.overlays.mesh);
  ImGui::Checkbox("Caustic textures", &draw.overlays.textureRegions);
  ImGui::Checkbox("Particle paths of an explanation", &draw.overlays.particles);
  ImGui::Checkbox("Statistics", &draw.overlays.statistics);
  ImGui::Separator();
  ImGui::Checkbox("Rays for mirrors, gloss and glass", &draw.cache);
  ImGui::Checkbox("Better picture at rest", &draw.picture);
}

namespace {
std::string bytes(std::uint64_t n) {
  return n < 10'000       ? fmt::format("{} B", n)
         : n < 10'000'000 ? fmt::format("{} kB", n / 1000)
                          : fmt::format("{} MB", n / 1'000'000);
}
}  // namespace

void statistics(const Controller& controller, const DrawReport& drawn, float pictureWidth) {
  const float width = 19 * ImGui::GetFontSize();
  ImGui::SetNextWindowPos({pictureWidth - width - 10, 10});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::SetNextWindowBgAlpha(0.8f);
  ImGui::Begin("##statistics", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  const StepReport& step = controller.status().step;
  if (ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingStretchProp)) {
    row("drawing", fmt::format("{:.1f} ms", drawn.milliseconds));
    row("of it render cache", fmt::format("{:.1f} ms", drawn.cacheMilliseconds));
    row("uploaded", bytes(drawn.uploadedBytes));
    row("triangles", std::to_string(drawn.triangles));
    row("cache pixels", fmt::format("{} of {}", drawn.cacheHeld, drawn.cacheWanted));
    row("last step", fmt::format("{:.0f} ms", 1e3 * step.times.total));
    row("rays", std::to_string(step.rays));
    row("leaves changed", std::to_string(step.leavesChanged));
    row("particles traced", fmt::format("{} of {}", step.particlesRetraced, step.particlesTotal));
    row("textures made", std::to_string(step.texturesRebuilt));
    row("last settling", fmt::format("{:.2f} s", controller.status().settleSeconds));
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace deltalux::viewer
