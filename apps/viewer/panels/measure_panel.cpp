#include "panels/measure_panel.hpp"

#include <imgui.h>

#include <algorithm>

#include "camera.hpp"
#include "panels/style.hpp"
#include "panels/widgets.hpp"

namespace deltalux::viewer {

namespace {
constexpr float kPlotHeight = 2.6f;  // of a probe's history, in lines of text

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

double luminous(const Contributions& c) { return gray(c.direct + c.indirect + c.particle); }

/// What is light of this, of all that is there.
std::string share(const glm::dvec3& E, const Contributions& all) {
  const double sum = luminous(all);
  return sum > 0 ? percent(gray(E) / sum) : "-";
}

bool beginRows(const char* id) {
  return ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_NoSavedSettings);
}

void kinds(const Contributions& c) {
  row("direct", share(c.direct, c));
  row("by way of surfaces", share(c.indirect, c));
  row("by mirrors, gloss, glass", share(c.particle, c));
}

void lampShares(const Contributions& c, const Scene& scene) {
  for (const Contributions::Lamp& lamp : c.lamps) row(scene[lamp.light].name, share(lamp.E, c));
}

std::string objectName(const Scene& scene, ObjectId id) { return id.valid() ? scene[id].name : "(without a name)"; }
}  // namespace

void underCursorPanel(const Controller& controller) {
  const UnderCursor& u = controller.underCursor();
  if (!u.known) {
    quietText("Point at a surface.");
    return;
  }
  const Scene& scene = controller.scene();
  if (!beginRows("cursor")) return;
  row("illuminance", fmt::format("{:.4g} lx", u.lux));
  row("luminance", fmt::format("{:.4g} cd/m\xc2\xb2", u.candelaPerSquareMetre));
  if (u.material.valid()) {
    row("reflectance, diffuse", percent(double(gray(diffuseReflectance(scene[u.material], true)))));
    row("material", scene[u.material].name);
  }
  row("object", objectName(scene, u.object));
  if (u.contributions && u.contributions->onSurface) {
    kinds(*u.contributions);
    lampShares(*u.contributions, scene);
  }
  ImGui::EndTable();
}

void probePanel(Controller& controller) {
  std::string unpinned;
  for (const Probe& probe : controller.probes()) {
    ImGui::PushID(probe.name.c_str());
    ImGui::Text("%s  %.4g lx%s", probe.name.c_str(), probe.lux, probe.exact ? "" : " (in motion)");
    ImGui::SameLine();
    if (ImGui::SmallButton("x")) unpinned = probe.name;
    if (probe.history.size() > 1) {
      const std::vector<float> history(probe.history.begin(), probe.history.end());
      const float most = *std::max_element(history.begin(), history.end());
      ImGui::PlotLines("##history", history.data(), int(history.size()), 0, nullptr, 0, 1.1f * most,
                       {ImGui::GetContentRegionAvail().x, kPlotHeight * ImGui::GetFontSize()});
    }
    ImGui::PopID();
  }
  if (!unpinned.empty()) controller.unpinProbe(unpinned);
  if (controller.probes().empty()) quietText("P pins a probe under the cursor.");
}

void fieldPanel(Controller& controller, Tools& tools) {
  const bool measuring = tools.click == ClickFor::FieldCorner || tools.click == ClickFor::FieldOpposite;
  if (measuring) {
    quietText(tools.click == ClickFor::FieldCorner ? "Click on one corner of the rectangle."
                                                   : "Click on the opposite corner.");
    if (ImGui::Button("Leave off")) tools.click = ClickFor::Selection;
  } else if (ImGui::Button(controller.field() ? "Measure out another" : "Measure out a rectangle")) {
    tools.click = ClickFor::FieldCorner;
  }
  if (!controller.field()) return;
  ImGui::SameLine();
  if (ImGui::Button("Remove")) {
    controller.setField(std::nullopt);
    return;
  }
  MeterField field = *controller.field();
  const double metres = controller.scene().metresPerUnit;
  int meters[2] = {field.columns, field.rows};
  if (ImGui::SliderInt2("meters", meters, 1, 64, "%d", ImGuiSliderFlags_AlwaysClamp)) {
    field.columns = meters[0], field.rows = meters[1];
    controller.setField(field);
  }
  if (!beginRows("field")) return;
  row("size", fmt::format("{:.2f} x {:.2f} m", metres * glm::length(field.across), metres * glm::length(field.along)));
  row("Em", fmt::format("{:.4g} lx", field.mean));
  row("Emin", fmt::format("{:.4g} lx", field.least));
  row("U0", fmt::format("{:.3f}", field.uniformity));
  ImGui::EndTable();
  if (!field.exact) quietText("In motion: the mesh's own values.");
}

void explanationPanel(Controller& controller) {
  const auto& e = controller.explanation();
  if (!e) {
    quietText("X asks why it is bright under the cursor.");
    return;
  }
  if (!e->onSurface) {
    quietText("There is no surface at that point.");
    return;
  }
  const Scene& scene = controller.scene();
  ImGui::Text("%.4g lx", photometric(e->direct + e->indirect + e->particle, scene.luminousEfficacy));
  if (!beginRows("explanation")) return;
  kinds(*e);
  if (!e->lamps.empty()) row("Lamps, straight", "");
  lampShares(*e, scene);
  if (!e->surfaces.empty()) row("Surfaces that reflect it here", "");
  for (const Contributions::Surface& s : e->surfaces) row(objectName(scene, s.object), share(s.E, *e));
  if (!e->paths.empty()) row("Paths of particles", "");
  for (std::size_t i = 0; i < e->paths.size(); ++i)
    row(fmt::format("{}: {} corners, {} particles", i + 1, e->paths[i].corners.size(), e->paths[i].particles),
        share(e->paths[i].E, *e));
  ImGui::EndTable();
  ImGui::Checkbox("Draw the paths", &controller.draw().overlays.particles);
}

void measureMarks(const Controller& controller, const Tools& tools, const Frame& frame, float scale) {
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const auto mark = [&](const Vec3& p, const std::string& text) {
    const Vec3 pixel = project(frame.camera, frame.width, frame.height, p);
    if (pixel.z <= 0) return;
    const ImVec2 at{float(pixel.x) / scale, float(pixel.y) / scale};
    const ImVec2 size = ImGui::CalcTextSize(text.c_str());
    list.AddCircleFilled(at, 4, IM_COL32(20, 21, 23, 255));
    list.AddCircleFilled(at, 3, IM_COL32(250, 220, 120, 255));
    list.AddRectFilled({at.x + 8, at.y - size.y / 2 - 2}, {at.x + size.x + 16, at.y + size.y / 2 + 2},
                       IM_COL32(20, 21, 23, 190), 3);
    list.AddText({at.x + 12, at.y - size.y / 2}, IM_COL32(240, 240, 240, 255), text.c_str());
  };
  for (const Probe& probe : controller.probes())
    mark(probe.point.position, fmt::format("{} {:.4g} lx", probe.name, probe.lux));
  if (tools.click == ClickFor::FieldOpposite) mark(tools.fieldCorner.position, "corner");
  if (const auto& f = controller.field())
    mark(f->corner + 0.5 * (f->across + f->along), fmt::format("Em {:.4g} lx  U0 {:.2f}", f->mean, f->uniformity));
}

}  // namespace deltalux::viewer
