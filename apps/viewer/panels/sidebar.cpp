#include "panels/sidebar.hpp"

#include <imgui.h>

#include <utility>

#include "panels/exposure_panel.hpp"
#include "panels/lamp_panel.hpp"
#include "panels/measure_panel.hpp"
#include "panels/scene_panel.hpp"
#include "panels/state_panel.hpp"

namespace deltalux::viewer {

namespace {
/// A panel under its title. `now`: opens it and brings it into sight.
template <class Content>
void panel(const char* title, bool atFirst, bool now, Content&& content) {
  if (now) ImGui::SetNextItemOpen(true);
  const bool open = ImGui::CollapsingHeader(title, atFirst ? ImGuiTreeNodeFlags_DefaultOpen : 0);
  if (now) ImGui::SetScrollHereY(0.2f);
  if (!open) return;
  ImGui::PushID(title);
  content();
  ImGui::PopID();
}
}  // namespace

float Sidebar::width() { return 22 * ImGui::GetFontSize(); }

void Sidebar::draw(Controller& controller, Tools& tools, const gl::Renderer& renderer, float pictureWidth,
                   float height) {
  ImGui::SetNextWindowPos({pictureWidth, 0});
  ImGui::SetNextWindowSize({width(), height});
  ImGui::Begin("##sidebar", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  ImGui::PushItemWidth(-7 * ImGui::GetFontSize());
  const bool explained = controller.explanation().has_value();
  const bool newExplanation = explained && !explained_;
  explained_ = explained;
  const bool newProbe = controller.probes().size() > std::exchange(pinned_, controller.probes().size());
  panel("Selection", true, false, [&] { selectionPanel(controller, tools, pending_, turn_); });
  panel("Lamps", true, false, [&] { lampPanel(controller, tools, pending_); });
  panel("Exposure", true, false, [&] { exposurePanel(controller); });
  panel("False colour", false, false, [&] { falseColourPanel(controller); });
  panel("Under the cursor", false, false, [&] { underCursorPanel(controller); });
  panel("Probes", false, newProbe, [&] { probePanel(controller); });
  panel("Rectangle of meters", false, false, [&] { fieldPanel(controller, tools); });
  panel("Why is it bright here?", false, newExplanation, [&] { explanationPanel(controller); });
  panel("States", false, false, [&] { statePanel(controller, tools); });
  panel("History", false, false, [&] { historyPanel(controller); });
  panel("Views", false, false, [&] { viewPanel(controller, tools); });
  panel("Section", false, false, [&] { sectionPanel(controller); });
  panel("Overlays", false, false, [&] { overlayPanel(controller); });
  panel("Files", false, false, [&] { files_.draw(controller, renderer); });
  ImGui::PopItemWidth();
  ImGui::End();
}

}  // namespace deltalux::viewer
