#pragma once
// Mouse and keyboard: what hands on the picture mean.
#include "gizmo_hand.hpp"
#include "keys.hpp"
#include "walk.hpp"

namespace deltalux::viewer {

class Hands {
 public:
  /// Takes what has happened since the frame before, inside ImGui's frame. `frame`: what was drawn last; `seconds`:
  /// since then. Precondition: controller.ready().
  void update(Controller&, Tools&, const Frame&, const std::vector<KeyPress>&, double seconds);
  /// What is drawn over the picture while hands are on it.
  void draw(const Controller&, const Frame&) const;
  /// Whether the next frame will differ without any new event.
  bool moving() const { return walk_.moving() || std::abs(zoom_) > 0; }
  const GizmoHand& gizmo() const { return gizmo_; }

 private:
  enum class Drag { None, Press, Look, Orbit, Object };

  void beginDrag(Controller&, Tools&, const Frame&);
  void goOn(Controller&, const Frame&);
  void end(Controller&, Tools&);
  void click(Controller&, Tools&);
  void walk(Controller&, const Tools&, double seconds);
  void zoom(Controller&, const Frame&, double seconds);
  Vec3 under(const Controller&, const Frame&) const;

  GizmoHand gizmo_;
  Walk walk_;
  Drag drag_ = Drag::None;
  Cursor cursor_, before_, pressed_;
  bool onPicture_ = false;
  Vec3 pivot_{0};    // what is orbited about
  double zoom_ = 0;  // steps of the wheel that are still to be made
  Vec3 zoomTowards_{0};
  double speed_ = 0;  // of walking [scene units / s]; 0: not known yet
};

}  // namespace deltalux::viewer
