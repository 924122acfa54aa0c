#include "panels/status_line.hpp"

#include <imgui.h>

#include "keys.hpp"
#include "panels/style.hpp"
#include "panels/widgets.hpp"

namespace deltalux::viewer {

namespace {
constexpr ImGuiWindowFlags kStatusFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoNav |
                                          ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                                          ImGuiWindowFlags_NoFocusOnAppearing;

ImVec4 badgeColour(const Status& s) {
  if (s.phase == Phase::Failed) return ink::kError;
  return s.phase == Phase::Settled ? ink::kCalm : ink::kBusy;
}

const char* hint(const Tools& tools) {
  switch (tools.click) {
    case ClickFor::Aim:
      return "Click on what the lamp shall shine at (Esc: leave off)";
    case ClickFor::FieldCorner:
      return "Click on a corner of the rectangle (Esc: leave off)";
    case ClickFor::FieldOpposite:
      return "Click on the opposite corner (Esc: leave off)";
    case ClickFor::Selection:
      break;
  }
  return tools.level ? "F1 keys" : "flying   F1 keys";
}

void refused(Controller& controller, float pictureHeight) {
  if (controller.lastError.empty()) return;
  ImGui::SetNextWindowPos({10, pictureHeight - statusHeight() - 8}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowBgAlpha(0.92f);
  ImGui::Begin("##refused", nullptr, kStatusFlags | ImGuiWindowFlags_AlwaysAutoResize);
  if (ImGui::SmallButton("x"))
    controller.lastError.clear();
  else {
    ImGui::SameLine();
    ImGui::TextColored(ink::kError, "%s", controller.lastError.c_str());
  }
  ImGui::End();
}
}  // namespace

std::string statusText(const Status& s) {
  const double percent = 100 * s.fraction;
  switch (s.phase) {
    case Phase::Opening:
      return fmt::format("opening {:.0f} %", percent);
    case Phase::Solving:
      return fmt::format("solving {:.0f} %", percent);
    case Phase::Moving:
    case Phase::Settling:
      return fmt::format("stale {:.1f} %", 100 * s.staleShare);
    case Phase::Settled:
      return "settled";
    case Phase::Failed:
      return "failed";
  }
  return {};
}

float statusHeight() { return ImGui::GetFontSize() + 12; }

void statusLine(Controller& controller, const Tools& tools, float pictureWidth, float pictureHeight) {
  const float height = statusHeight();
  ImGui::SetNextWindowPos({0, pictureHeight - height});
  ImGui::SetNextWindowSize({pictureWidth, height});
  ImGui::SetNextWindowBgAlpha(0.78f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {10, 6});
  ImGui::Begin("##status", nullptr, kStatusFlags | ImGuiWindowFlags_NoInputs);
  const Status& status = controller.status();
  ImGui::TextColored(badgeColour(status), "%s", statusText(status).c_str());
  if (!status.message.empty()) {
    ImGui::SameLine(0, 18);
    ImGui::TextColored(ink::kError, "%s", status.message.c_str());
  }
  const UnderCursor& u = controller.underCursor();
  if (u.known) {
    ImGui::SameLine(0, 18);
    ImGui::Text("%.4g lx   %.4g cd/m\xc2\xb2", u.lux, u.candelaPerSquareMetre);
  }
  ImGui::SameLine(0, 18);
  ImGui::TextColored(ink::kQuiet, "EV %+.2f", controller.draw().tone.ev);
  if (!controller.selection().empty()) {
    ImGui::SameLine(0, 18);
    ImGui::TextUnformatted(controller.selection().c_str());
  }
  const char* const right = hint(tools);
  ImGui::SameLine(std::max(pictureWidth - ImGui::CalcTextSize(right).x - 12, ImGui::GetCursorPosX()));
  ImGui::TextColored(tools.click == ClickFor::Selection ? ink::kQuiet : ink::kBusy, "%s", right);
  ImGui::End();
  ImGui::PopStyleVar();
  refused(controller, pictureHeight);
}

void openingNotice(const Status& status, const std::string& title, float width, float height) {
  ImGui::SetNextWindowPos({0.5f * width, 0.5f * height}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({std::min(28 * ImGui::GetFontSize(), width), 0});
  ImGui::SetNextWindowBgAlpha(0);
  ImGui::Begin("##opening", nullptr, kStatusFlags | ImGuiWindowFlags_NoInputs);
  ImGui::TextUnformatted(title.c_str());
  if (status.phase == Phase::Failed)
    ImGui::TextColored(ink::kError, "%s", status.message.c_str());
  else
    ImGui::ProgressBar(float(status.fraction), {-FLT_MIN, 6}, "");
  ImGui::TextColored(ink::kQuiet, "%s", statusText(status).c_str());
  ImGui::End();
}

void keyList(Tools& tools) {
  if (!tools.keys) return;
  ImGui::SetNextWindowPos({24, 24}, ImGuiCond_Appearing);
  ImGui::Begin("Keys", &tools.keys,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    const auto line = [](const char* name, const char* does) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(name);
      ImGui::TableNextColumn();
      ImGui::TextColored(ink::kQuiet, "%s", does);
    };
    for (const auto& [name, does] : handMoves()) line(name, does);
    for (const KeyBinding& binding : keyBindings()) line(binding.name, binding.does);
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace deltalux::viewer
