#include "panels/state_panel.hpp"

#include <imgui.h>

#include "panels/widgets.hpp"

namespace deltalux::viewer {

namespace {
constexpr const char* kSlots[] = {"A", "B"};
constexpr std::size_t kShown = 12;  // steps of the record, the newest
}  // namespace

void statePanel(Controller& controller, Tools& tools) {
  for (int slot = 0; slot < 2; ++slot) {
    const auto& all = controller.session().stored();
    const bool there = std::size_t(slot) < all.size() && all[std::size_t(slot)].has_value();
    ImGui::PushID(slot);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(kSlots[slot]);
    ImGui::SameLine();
    if (ImGui::Button("Store")) controller.store(slot);
    if (there) {
      ImGui::SameLine();
      if (ImGui::Button("Restore")) attempt(controller, [&] { controller.restore(slot); });
      ImGui::SameLine();
      bool beside = tools.compared == slot;
      if (ImGui::Checkbox("Beside", &beside)) compareWith(controller, tools, beside ? slot : -1, 0.5);
    }
    ImGui::PopID();
  }
  if (tools.compared < 0) return;
  double wipe = tools.wipe;
  if (slider("now / stored", wipe, 0, 1, "", ImGuiSliderFlags_AlwaysClamp))
    compareWith(controller, tools, tools.compared, wipe);
}

std::string describe(const EditStep& step) {
  if (std::holds_alternative<Undo>(step)) return "undo";
  if (std::holds_alternative<Redo>(step)) return "redo";
  const Edit& edit = std::get<Edit>(step);
  const std::string subject = editSubject(edit);
  return subject.empty() ? editOperation(edit) : editOperation(edit) + " " + subject;
}

void historyPanel(Controller& controller) {
  const Session& session = controller.session();
  ImGui::BeginDisabled(!session.canUndo());
  if (ImGui::Button("Undo")) attempt(controller, [&] { controller.undo(); });
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!session.canRedo());
  if (ImGui::Button("Redo")) attempt(controller, [&] { controller.redo(); });
  ImGui::EndDisabled();
  const std::vector<EditStep>& steps = session.recording().steps;
  for (std::size_t i = steps.size(), shown = 0; i > 0 && shown < kShown; --i, ++shown)
    quietText(fmt::format("{}  {}", i, describe(steps[i - 1])));
}

void wipeLine(const Tools& tools, float pictureWidth, float pictureHeight) {
  if (tools.compared < 0 || tools.wipe >= 1) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float x = float(tools.wipe) * pictureWidth;
  list.AddLine({x, 0}, {x, pictureHeight}, IM_COL32(235, 235, 235, 200), 1.5f);
  if (tools.wipe > 0.05) list.AddText({x - ImGui::CalcTextSize("now ").x - 4, 8}, IM_COL32(235, 235, 235, 255), "now");
  list.AddText({x + 8, 8}, IM_COL32(235, 235, 235, 255), kSlots[tools.compared]);
}

}  // namespace deltalux::viewer
