#include "hands.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <utility>

#include "camera.hpp"
#include "meter_rectangle.hpp"

namespace deltalux::viewer {

namespace {
constexpr double kClickReach = 4;    // a press that moved less is a click [pixels]
constexpr double kWheelStep = 0.85;  // of the distance that a step of the wheel leaves
constexpr double kWheelEase = 0.05;  // time in which most of a step is made [s]
constexpr double kWheelRest = 0.01;  // of a step, made at once
constexpr double kLongest = 0.1;     // time a frame may move by: after a pause one does not leap [s]
constexpr double kEmptyDepth = 0.3;  // where the ray meets nothing it counts as this far, of the scene's diagonal

bool keyHeld(int key) { return ImGui::IsKeyDown(key); }  // ImGui has GLFW's codes

double keyAxis(int forth, int forthToo, int back, int backToo) {
  return double(keyHeld(forth) || keyHeld(forthToo)) - double(keyHeld(back) || keyHeld(backToo));
}
}  // namespace

Vec3 Hands::under(const Controller& controller, const Frame& frame) const {
  if (const auto hit = controller.hitAt(cursor_.x, cursor_.y)) return hit->position;
  const ViewRay ray = rayThrough(frame.camera, frame.width, frame.height, cursor_.x, cursor_.y);
  return ray.origin + kEmptyDepth * bounds(controller.scene()).diagonal() * ray.direction;
}

void Hands::update(Controller& controller, Tools& tools, const Frame& frame, const std::vector<KeyPress>& keys,
                   double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  before_ = cursor_;
  const bool here = ImGui::IsMousePosValid();
  if (here)
    cursor_ = {double(io.MousePos.x * io.DisplayFramebufferScale.x),
               double(io.MousePos.y * io.DisplayFramebufferScale.y)};
  onPicture_ = here && !io.WantCaptureMouse && cursor_.x >= 0 && cursor_.y >= 0 && cursor_.x < frame.width &&
               cursor_.y < frame.height;
  if (drag_ == Drag::None) gizmo_.hover(controller, frame, tools, cursor_, onPicture_);
  KeyContext context{controller, tools, cursor_.x, cursor_.y, onPicture_};
  for (const KeyPress& key : keys) {
    if (key.key == GLFW_KEY_ESCAPE && gizmo_.dragging())
      gizmo_.cancel(controller), drag_ = Drag::None;
    else
      press(key, context);
  }
  beginDrag(controller, tools, frame);
  goOn(controller, frame);
  end(controller, tools);
  walk(controller, tools, std::min(seconds, kLongest));
  zoom(controller, frame, std::min(seconds, kLongest));
  const bool moved = cursor_.x != before_.x || cursor_.y != before_.y;
  if (moved && onPicture_ && drag_ == Drag::None && tools.panels) controller.pointAt(cursor_.x, cursor_.y);
}

void Hands::beginDrag(Controller& controller, Tools& tools, const Frame& frame) {
  if (!onPicture_ || drag_ != Drag::None) return;
  const bool left = ImGui::IsMouseClicked(ImGuiMouseButton_Left);
  pressed_ = cursor_;
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Middle) || (left && ImGui::GetIO().KeyAlt)) {
    drag_ = Drag::Orbit, pivot_ = under(controller, frame);
  } else if (ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
    drag_ = Drag::Look;
  } else if (left && keyHeld(GLFW_KEY_G)) {
    const std::string name = controller.nameAt(cursor_.x, cursor_.y);
    if (controller.selection().empty() && !name.empty()) {
      attempt(controller, [&] { controller.select(name); });
      gizmo_.hover(controller, frame, tools, cursor_, false);
    }
    if (gizmo_.takeToSlide(controller, frame, cursor_)) drag_ = Drag::Object;
  } else if (left) {
    drag_ = gizmo_.take(controller, frame, cursor_) ? Drag::Object : Drag::Press;
  }
}

void Hands::goOn(Controller& controller, const Frame& frame) {
  const double dx = cursor_.x - before_.x, dy = cursor_.y - before_.y;
  if (drag_ == Drag::None || drag_ == Drag::Press || (dx == 0 && dy == 0)) return;
  if (drag_ == Drag::Object) {
    gizmo_.drag(controller, frame, cursor_, ImGui::GetIO().KeyCtrl);
    return;
  }
  View camera = controller.camera();
  if (drag_ == Drag::Look) {  // as fast as what is in the middle moves under the cursor
    const bool angles = camera.kind == View::Kind::Perspective;
    const double angle = glm::radians(angles ? frame.camera.horizontal : 60.0) / frame.width;
    turn(camera, -dx * angle, -dy * angle);
  } else {  // half a turn over the width of the picture
    orbit(camera, pivot_, -dx * kPi / frame.width, -dy * kPi / frame.width);
  }
  controller.setCamera(camera);
}

void Hands::end(Controller& controller, Tools& tools) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool down = io.MouseDown[ImGuiMouseButton_Left] || io.MouseDown[ImGuiMouseButton_Right] ||
                    io.MouseDown[ImGuiMouseButton_Middle];
  if (drag_ == Drag::None || down) return;
  if (drag_ == Drag::Object) gizmo_.release(controller);
  const double way = std::hypot(cursor_.x - pressed_.x, cursor_.y - pressed_.y);
  const bool clicked = drag_ == Drag::Press && way < kClickReach;
  drag_ = Drag::None;
  if (clicked) attempt(controller, [&] { click(controller, tools); });
}

void Hands::click(Controller& controller, Tools& tools) {
  if (tools.click == ClickFor::Selection) {
    const std::string top = controller.nameAt(pressed_.x, pressed_.y);
    const bool again = !top.empty() && top == controller.selection();
    controller.select(again ? controller.nameAt(pressed_.x, pressed_.y, true) : top);
    return;
  }
  const auto hit = controller.hitAt(pressed_.x, pressed_.y);
  if (!hit) return;
  if (tools.click == ClickFor::FieldCorner) {
    tools.fieldCorner = *hit, tools.click = ClickFor::FieldOpposite;
    return;
  }
  const ClickFor purpose = std::exchange(tools.click, ClickFor::Selection);
  if (purpose == ClickFor::Aim) {
    controller.aim(tools.lamp, hit->position);
  } else if (auto field = fieldBetween(tools.fieldCorner, hit->position, glm::normalize(controller.scene().up))) {
    if (const auto& old = controller.field()) field->columns = old->columns, field->rows = old->rows;
    controller.setField(field);
  }
}

void Hands::walk(Controller& controller, const Tools& tools, double seconds) {
  const ImGuiIO& io = ImGui::GetIO();
  if (speed_ == 0) speed_ = walkingSpeed(controller.scene());
  Steps steps;
  if (!io.WantTextInput && !io.KeyCtrl && !io.KeyAlt) {
    steps.rightForwardUp = {keyAxis(GLFW_KEY_D, GLFW_KEY_RIGHT, GLFW_KEY_A, GLFW_KEY_LEFT),
                            keyAxis(GLFW_KEY_W, GLFW_KEY_UP, GLFW_KEY_S, GLFW_KEY_DOWN),
                            double(keyHeld(GLFW_KEY_E)) - double(keyHeld(GLFW_KEY_Q))};
    steps.fast = io.KeyShift;
  }
  View camera = controller.camera();
  if (walk_.advance(camera, steps, tools.level, speed_, seconds)) controller.setCamera(camera);
}

void Hands::zoom(Controller& controller, const Frame& frame, double seconds) {
  const float wheel = ImGui::GetIO().MouseWheel;
  if (wheel != 0 && onPicture_) {
    if (zoom_ == 0) zoomTowards_ = under(controller, frame);
    zoom_ += double(wheel);
  }
  if (zoom_ == 0) return;
  const double share = std::abs(zoom_) < kWheelRest ? 1 : 1 - std::exp(-seconds / kWheelEase);
  View camera = controller.camera();
  dolly(camera, zoomTowards_, std::pow(kWheelStep, share * zoom_));
  zoom_ = share == 1 ? 0 : zoom_ * (1 - share);
  controller.setCamera(camera);
}

void Hands::draw(const Controller& controller, const Frame& frame) const {
  drawGizmo(gizmo_, frame, controller.scene(), ImGui::GetIO().DisplayFramebufferScale.x);
}

}  // namespace deltalux::viewer
