#include "panels/lamp_panel.hpp"

#include <map>

#include "lamps.hpp"
#include "panels/style.hpp"

namespace deltalux::viewer {

namespace {
constexpr float kMostLevel = 4;  // of the sliders; more can be typed

void dimTo(Controller& controller, const std::string& name, const LampLevel& now, float level) {
  if (!now.on) controller.switchLight(name, true);
  if (now.level > 0)
    controller.dim(name, double(level / now.level));
  else
    controller.colour(name, Rgb(level));  // from 0 no factor leads anywhere
}

void aimAndLook(Controller& controller, Tools& tools, const std::string& name, LightId light) {
  if (!aimOf(controller.scene(), light)) return;
  const bool aiming = tools.click == ClickFor::Aim && tools.lamp == name;
  if (ImGui::SmallButton(aiming ? "click on a surface" : "Aim at")) {
    tools.click = aiming ? ClickFor::Selection : ClickFor::Aim;
    tools.lamp = name;
  }
  if (!placeOf(controller.scene(), light)) return;
  ImGui::SameLine();
  if (ImGui::SmallButton("Look through")) attempt(controller, [&] { controller.lookThrough(name); });
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

void lampControls(Controller& controller, Tools& tools, Pending& pending, const std::string& name, LightId first) {
  const LampLevel now = lampLevel(controller.scene(), first);
  ImGui::PushID(name.c_str());
  bool on = now.on;
  if (ImGui::Checkbox("##on", &on)) attempt(controller, [&] { controller.switchLight(name, on); });
  if (ImGui::IsItemHovered()) ImGui::SetTooltip(on ? "On" : "Off");
  ImGui::SameLine();
  Rgb colour = now.colour;
  if (heldColour(pending, "##colour", colour, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float))
    attempt(controller, [&] { controller.colour(name, colour * now.level); });
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-FLT_MIN);
  float level = now.level;
  if (heldSlider(pending, "##level", level, 0, kMostLevel, "x %.3g", ImGuiSliderFlags_Logarithmic))
    attempt(controller, [&] { dimTo(controller, name, now, std::max(level, 0.0f)); });
  aimAndLook(controller, tools, name, first);
  ImGui::PopID();
}

void lampPanel(Controller& controller, Tools& tools, Pending& pending) {
  for (const LampGroup& group : lampGroups(controller.scene())) {
    const bool chosen = controller.selection() == group.name;
    ImGui::PushID(group.name.c_str());
    if (ImGui::Selectable(group.name.c_str(), chosen)) attempt(controller, [&] { controller.select(group.name); });
    lampControls(controller, tools, pending, group.name, group.lights.front());
    if (group.lights.size() > 1 && ImGui::TreeNode("parts", "%d parts", int(group.lights.size()))) {
      for (const LightId id : group.lights) {
        const std::string name = controller.scene()[id].name;
        quietText(name);
        lampControls(controller, tools, pending, name, id);
      }
      ImGui::TreePop();
    }
    ImGui::PopID();
  }
  if (controller.scene().lights.empty()) quietText("The scene has no lamps.");
}

}  // namespace deltalux::viewer
