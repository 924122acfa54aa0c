#include "panels/selection_panel.hpp"

#include <algorithm>

#include "gizmo.hpp"
#include "panels/lamp_panel.hpp"
#include "selection_place.hpp"

namespace deltalux::viewer {

namespace {
/// The middle of the thing, in metres of the scene's files; typing another moves it there.
void position(Controller& controller, Pending& pending, const SelectionPlace& place) {
  const Scene& scene = controller.scene();
  const Vec3 inMetres = scene.metresPerUnit * (place.box.center() + scene.origin);
  Vec3 typed = inMetres;
  ImGui::SetNextItemWidth(-FLT_MIN);
  quietText("Middle at x y z [m]");
  ImGui::SetNextItemWidth(-FLT_MIN);
  if (heldNumbers(pending, "##position", typed, "%.3f") && typed != inMetres)
    attempt(controller, [&] {
      Mat4 matrix(1.0);
      matrix[3] = glm::dvec4((typed - inMetres) / scene.metresPerUnit, 1);
      controller.edit(TransformObject{controller.selection(), matrix});
    });
  const Vec3 size = scene.metresPerUnit * place.box.extent();
  quietText(fmt::format("{:.3g} x {:.3g} x {:.3g} m", size.x, size.y, size.z));
}

int uprightAxis(const Scene& scene) {
  const Vec3 up = glm::abs(scene.up);
  return up.x > up.y && up.x > up.z ? 0 : up.y > up.z ? 1 : 2;
}

void turnBy(Controller& controller, const Tools& tools, const SelectionPlace& place, TypedTurn& turn) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  const float unit = ImGui::GetFontSize();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("Turn about");
  ImGui::SameLine();
  ImGui::SetNextItemWidth(3 * unit);
  int axis = turn.axis.value_or(uprightAxis(controller.scene()));
  if (ImGui::Combo("##axis", &axis, kAxes, 3)) turn.axis = axis;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(4.5f * unit);
  ImGui::InputFloat("##degrees", &turn.degrees, 0, 0, "%.1f\xc2\xb0");
  ImGui::SameLine();
  if (!ImGui::Button("Turn")) return;
  const Scene& scene = controller.scene();
  const glm::dmat3 axes = tools.localAxes ? place.axes : glm::dmat3(1.0);
  const Mat4 map = rotationAbout(place.box.center(), axes[axis], double(turn.degrees));
  attempt(controller, [&] { controller.edit(TransformObject{controller.selection(), inFiles(map, scene.origin)}); });
}

void materials(Controller& controller, Pending& pending, const SelectionPlace& place) {
  const Scene& scene = controller.scene();
  std::vector<MaterialId> ids;
  for (const PrimitiveId p : place.primitives) ids.push_back(scene[p].material);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  for (const MaterialId id : ids) {
    const Material material = scene[id];  // a copy: edits may add some
    const Mirror* mirror = std::get_if<Mirror>(&material.surface);
    const Opaque* opaque = std::get_if<Opaque>(&material.surface);
    if (!mirror && !opaque) {
      quietText(fmt::format("{}: passes light on", material.name));
      continue;
    }
    const bool metal = opaque && isBlack(opaque->diffuse);  // its reflectance is its lobe's (SetMaterial)
    Rgb rho = mirror ? mirror->reflectance : metal ? opaque->specular.reflectance : opaque->diffuse;
    ImGui::PushID(int(id.index()));
    if (heldColour(pending, "##reflectance", rho, ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float) ==
        Held::Released)
      attempt(controller, [&] { controller.paint(material.name, glm::clamp(rho, 0.0f, 1.0f)); });
    ImGui::SameLine();
    ImGui::Text("%s  %.0f %%", material.name.c_str(), 100.0 * double(gray(rho)));
    if (opaque && !isBlack(opaque->specular.reflectance)) {
      float roughness = opaque->specular.roughness;
      ImGui::SetNextItemWidth(-6 * ImGui::GetFontSize());
      if (heldSlider(pending, "roughness", roughness, 0, 1, "%.3f") == Held::Released)
        attempt(controller, [&] { controller.edit(SetMaterial{material.name, std::nullopt, roughness}); });
    }
    ImGui::PopID();
  }
}
}  // namespace

void selectionPanel(Controller& controller, Tools& tools, Pending& pending, TypedTurn& turn) {
  const std::string name = controller.selection();
  if (name.empty()) {
    quietText("Click on something in the picture.");
    return;
  }
  ImGui::TextWrapped("%s", name.c_str());
  const auto place = placeOf(controller.scene(), name);
  const std::vector<LightId> lights = findLights(controller.scene(), name);
  if (!lights.empty()) {
    lampControls(controller, pending, name, lights.front());
    lampAim(controller, tools, name, lights.front());
  }
  if (place && !place->primitives.empty()) {
    position(controller, pending, *place);
    turnBy(controller, tools, *place, turn);
    ImGui::Checkbox("Along its own axes (L)", &tools.localAxes);
    materials(controller, pending, *place);
  }
  if (place && ImGui::Button("Look at it (F)")) controller.focusOnSelection();
  if (place && !place->primitives.empty()) {
    ImGui::SameLine();
    if (ImGui::Button("Remove"))
      attempt(controller, [&] {
        controller.edit(RemoveObject{name});
        controller.select("");
      });
  }
}

}  // namespace deltalux::viewer
