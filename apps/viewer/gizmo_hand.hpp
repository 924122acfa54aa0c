#pragma once
// The hand on the gizmo: which handle the cursor is on, a drag from press to release, and sliding over surfaces.
#include "gizmo.hpp"
#include "mesh_pick.hpp"
#include "selection_place.hpp"
#include "tools.hpp"

namespace deltalux::viewer {

/// A cursor on the picture.
struct Cursor {
  double x = 0, y = 0;  // [pixels], from the top left
};

class GizmoHand {
 public:
  /// Looks where the handles are now and which of them the cursor is on. Not while dragging.
  void hover(const Controller&, const Frame&, const Tools&, Cursor, bool onPicture);
  /// Takes hold of the handle under the cursor. False: there is none.
  bool take(Controller&, const Frame&, Cursor);
  /// Takes hold of the selected object itself, to slide it. False: there is nothing behind it to slide on.
  bool takeToSlide(Controller&, const Frame&, Cursor);
  void drag(Controller&, const Frame&, Cursor, bool snap);
  void release(Controller&);
  /// Puts the object back to where it was.
  void cancel(Controller&);
  bool dragging() const { return dragging_; }
  /// Where the handles are now; nullopt: nothing is selected.
  const std::optional<Gizmo>& gizmo() const { return gizmo_; }
  Handle handle() const { return handle_; }  // under the cursor, or held
  /// Of the drag that goes on, or the last.
  const GizmoDrag& dragged() const { return drag_; }

 private:
  void begin(Controller&);

  std::optional<Gizmo> gizmo_;
  Handle handle_ = Handle::None;
  bool dragging_ = false;
  Gizmo start_;     // where the handles were when the drag began
  ViewRay from_{};  // the ray on which it was taken hold of
  GizmoDrag drag_;
  std::optional<MeshPick> ground_;  // while sliding: all but the object
  Vec3 grabbed_{0};                 // what was behind the cursor when it began to slide
};

/// The handles over the picture, and how far they have come. `scale`: pixels of the framebuffer a unit of ImGui.
void drawGizmo(const GizmoHand&, const Frame&, const Scene&, float scale);

}  // namespace deltalux::viewer
