#include "gizmo_hand.hpp"

#include <imgui.h>

#include "camera.hpp"
#include "panels/style.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kReach = 7;         // of a handle [pixels]
constexpr double kSnapMetres = 0.1;  // steps of a move with Ctrl
constexpr double kSnapDegrees = 5;   // and of a turn

ViewRay rayAt(const Frame& frame, Cursor c) { return rayThrough(frame.camera, frame.width, frame.height, c.x, c.y); }

/// The snapshot less some surfaces: what an object can slide on.
SolutionMesh meshWithout(SolutionMesh mesh, const std::vector<PrimitiveId>& primitives) {
  for (const PrimitiveId id : primitives)
    for (const bool front : {true, false}) mesh.surfaces[SolutionMesh::side(id, front)] = nullptr;
  return mesh;
}
}  // namespace

void GizmoHand::hover(const Controller& controller, const Frame& frame, const Tools& tools, Cursor cursor,
                      bool onPicture) {
  gizmo_.reset(), handle_ = Handle::None;
  const auto place = placeOf(controller.scene(), controller.selection());
  if (!place) return;
  gizmo_ = gizmoAt(place->box.center(), tools.localAxes ? place->axes : glm::dmat3(1.0), frame.camera);
  if (onPicture && tools.click == ClickFor::Selection)
    handle_ = handleAt(*gizmo_, frame.camera, frame.width, frame.height, cursor.x, cursor.y, kReach);
}

void GizmoHand::begin(Controller& controller) {
  attempt(controller, [&] {
    controller.beginDrag();
    dragging_ = true, start_ = *gizmo_, drag_ = {};
  });
}

bool GizmoHand::take(Controller& controller, const Frame& frame, Cursor cursor) {
  if (handle_ == Handle::None || !gizmo_) return false;
  from_ = rayAt(frame, cursor);
  ground_.reset();
  begin(controller);
  return dragging_;
}

bool GizmoHand::takeToSlide(Controller& controller, const Frame& frame, Cursor cursor) {
  const auto place = placeOf(controller.scene(), controller.selection());
  if (!place || !gizmo_ || !frame.mesh || place->primitives.empty()) return false;
  ground_.emplace().follow(std::make_shared<SolutionMesh>(meshWithout(*frame.mesh, place->primitives)));
  const ViewRay ray = rayAt(frame, cursor);
  const auto behind = ground_->first(ray.origin, ray.direction, frame.settings.section);
  if (!behind) return false;
  handle_ = Handle::None, grabbed_ = behind->surface.position;
  begin(controller);
  return dragging_;
}

void GizmoHand::drag(Controller& controller, const Frame& frame, Cursor cursor, bool snap) {
  const double unit = controller.scene().metresPerUnit;
  const Snap steps = snap ? Snap{kSnapMetres / unit, kSnapDegrees} : Snap{};
  std::optional<GizmoDrag> now;
  const ViewRay ray = rayAt(frame, cursor);
  if (!ground_) {
    now = viewer::dragged(start_, handle_, from_, ray, steps);
  } else if (const auto hit = ground_->first(ray.origin, ray.direction, frame.settings.section)) {
    now.emplace();
    for (int i = 0; i < 3; ++i) {
      const double way = hit->surface.position[i] - grabbed_[i];
      now->offset[i] = steps.length > 0 ? steps.length * std::round(way / steps.length) : way;
    }
    now->matrix[3] = glm::dvec4(now->offset, 1);
  }
  if (!now || now->matrix == drag_.matrix) return;
  attempt(controller, [&] {
    controller.dragTo(inFiles(now->matrix, controller.scene().origin));
    drag_ = *now;
    gizmo_->centre = Vec3(drag_.matrix * glm::dvec4(start_.centre, 1));
  });
}

void GizmoHand::release(Controller& controller) {
  if (!dragging_) return;
  dragging_ = false;
  attempt(controller, [&] { controller.endDrag(); });
}

void GizmoHand::cancel(Controller& controller) {
  if (!dragging_) return;
  attempt(controller, [&] { controller.dragTo(Mat4(1.0)); });
  drag_ = {};
  release(controller);
}

namespace {
/// "+0.40 m", along one axis or several; or "35.0 degrees".
std::string amount(const GizmoHand& hand, double metresPerUnit) {
  const GizmoDrag& d = hand.dragged();
  const Handle h = hand.handle();
  if (h != Handle::None && !moves(h)) return fmt::format("{:+.1f}\xc2\xb0", d.degrees);
  if (movesAlong(h)) return fmt::format("{:+.3f} m", d.offset[axisOf(h)] * metresPerUnit);
  const Vec3 m = d.offset * metresPerUnit;
  return fmt::format("{:+.3f} {:+.3f} {:+.3f} m", m.x, m.y, m.z);
}

ImVec2 at(const Vec3& pixel, float scale) { return {float(pixel.x) / scale, float(pixel.y) / scale}; }

void drawHandle(ImDrawList& list, const Gizmo& gizmo, Handle h, bool strong, const Frame& frame, float scale) {
  const ImU32 colour = axisColour(axisOf(h), strong);
  std::vector<ImVec2> pixels;
  for (const Vec3& p : outline(gizmo, h)) {
    const Vec3 pixel = project(frame.camera, frame.width, frame.height, p);
    if (pixel.z <= 0) return;
    pixels.push_back(at(pixel, scale));
  }
  if (moves(h) && !movesAlong(h))
    list.AddConvexPolyFilled(pixels.data(), int(pixels.size()),
                             (colour & 0x00ffffffu) | (strong ? 0x90000000u : 0x50000000u));
  list.AddPolyline(pixels.data(), int(pixels.size()), colour, movesAlong(h) ? 0 : ImDrawFlags_Closed,
                   movesAlong(h) ? 3.0f : 1.6f);
  if (movesAlong(h)) list.AddCircleFilled(pixels.back(), strong ? 6.0f : 5.0f, colour);
}
}  // namespace

void drawGizmo(const GizmoHand& hand, const Frame& frame, const Scene& scene, float scale) {
  if (!hand.gizmo()) return;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const Handle h : kHandles)
    if (!hand.dragging() || h == hand.handle()) drawHandle(list, *hand.gizmo(), h, h == hand.handle(), frame, scale);
  if (!hand.dragging()) return;
  const Vec3 centre = project(frame.camera, frame.width, frame.height, hand.gizmo()->centre);
  if (centre.z <= 0) return;
  const std::string text = amount(hand, scene.metresPerUnit);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImVec2 place = at(centre, scale);
  place.x += 18, place.y += 18;
  list.AddRectFilled({place.x - 6, place.y - 3}, {place.x + size.x + 6, place.y + size.y + 3},
                     IM_COL32(20, 21, 23, 220), 3);
  list.AddText(place, IM_COL32(240, 240, 240, 255), text.c_str());
}

}  // namespace deltalux::viewer
