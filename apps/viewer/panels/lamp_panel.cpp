#include "panels/lamp_panel.hpp"

#include <map>

#include "lamps.hpp"
#include "panels/style.hpp"

namespace deltalux::viewer {

namespace {
constexpr float kMostLevel = 4;  // of the sliders; more can be typed

constexpr const char* kAim = "Aim at";
constexpr const char* kLook = "Look through";

bool aims(const Scene& scene, LightId light) { return placeOf(scene, light) && aimOf(scene, light); }

/// Width of lampAim's buttons.
float aimWidth() {
  const ImGuiStyle& style = ImGui::GetStyle();
  return ImGui::CalcTextSize(kAim).x + ImGui::CalcTextSize(kLook).x + 4 * style.FramePadding.x +
         2 * style.ItemSpacing.x;
}

/// The light follows the hand; from 0 no factor leads anywhere.
Edit levelEdit(const std::string& name, float start, float level) {
  if (start > 0) return ScaleLight{name, level / start};
  return ColourLight{name, Rgb(level)};
}

void follow(Controller& controller, Held what, const Edit& edit) {
  if (what == Held::Changed) attempt(controller, [&] { controller.adjust(edit); });
  if (what == Held::Released) {
    attempt(controller, [&] { controller.adjust(edit); });
    attempt(controller, [&] { controller.endAdjust(); });
  }
}
}  // namespace

std::vector<LampGroup> lampGroups(const Scene& scene) {
  std::vector<LampGroup> groups;
  std::map<std::string, std::size_t> known;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string& name = scene.lights[i].name;
    const std::string first = name.substr(0, name.find('.'));
    const auto [at, isNew] = known.emplace(first, groups.size());
    if (isNew) groups.push_back({first, {}});
    groups[at->second].lights.emplace_back(i);
  }
  for (LampGroup& group : groups)
    if (group.lights.size() == 1) group.name = scene[group.lights.front()].name;
  return groups;
}

LampLevel lampLevel(const Scene& scene, LightId id) {
  LampLevel level;
  Rgb scale = scene[id].scale;
  for (const SwitchedOff& off : scene.switchedOff)
    if (off.light == id) scale = off.scale, level.on = false;
  level.level = maxChannel(scale);
  if (level.level > 0) level.colour = scale / level.level;
  return level;
}

void lampAim(Controller& controller, Tools& tools, const std::string& name, LightId first) {
  if (!aims(controller.scene(), first)) return;
  ImGui::PushID(name.c_str());
  const bool aiming = tools.click == ClickFor::Aim && tools.lamp == name;
  if (aiming) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  const bool pressed = ImGui::SmallButton(kAim);
  if (aiming) ImGui::PopStyleColor();
  if (pressed) tools.click = aiming ? ClickFor::Selection : ClickFor::Aim, tools.lamp = name;
  ImGui::SameLine();
  if (ImGui::SmallButton(kLook)) attempt(controller, [&] { controller.lookThrough(name); });
  ImGui::PopID();
}

void lampControls(Controller& controller, Pending& pending, const std::string& name, LightId first) {
  const LampLevel now = lampLevel(controller.scene(), first);
  ImGui::PushID(name.c_str());
  bool on = now.on;
  if (ImGui::Checkbox("##on", &on)) attempt(controller, [&] { controller.switchLight(name, on); });
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(on ? "On" : "Off");
  ImGui::SameLine();
  Rgb colour = now.colour;
  const Held tinted = heldColour(pending, "##colour", colour, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float);
  follow(controller, tinted, ColourLight{name, colour * now.level});
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-FLT_MIN);
  float level = now.level;
  const Held dimmed = heldSlider(pending, "##level", level, 0, kMostLevel, "x %.3g", ImGuiSliderFlags_Logarithmic);
  if (dimmed == Held::Changed && !now.on) attempt(controller, [&] { controller.switchLight(name, true); });
  follow(controller, dimmed, levelEdit(name, pending.start[0], std::max(level, 0.0f)));
  ImGui::PopID();
}

void lampPanel(Controller& controller, Tools& tools, Pending& pending) {
  for (const LampGroup& group : lampGroups(controller.scene())) {
    const bool chosen = controller.selection() == group.name;
    ImGui::PushID(group.name.c_str());
    const LightId first = group.lights.front();
    const bool aimed = aims(controller.scene(), first);
    const float width = ImGui::GetContentRegionAvail().x - (aimed ? aimWidth() : 0);
    if (ImGui::Selectable(group.name.c_str(), chosen, 0, {width, 0}))
      attempt(controller, [&] { controller.select(group.name); });
    if (aimed) ImGui::SameLine();
    lampAim(controller, tools, group.name, first);
    lampControls(controller, pending, group.name, first);
    if (group.lights.size() > 1 && ImGui::TreeNode("parts", "%d parts", int(group.lights.size()))) {
      for (const LightId id : group.lights) {
        const std::string name = controller.scene()[id].name;
        quietText(name);
        lampControls(controller, pending, name, id);
        lampAim(controller, tools, name, id);
      }
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  if (controller.scene().lights.empty()) quietText("The scene has no lamps.");
}

}  // namespace deltalux::viewer
