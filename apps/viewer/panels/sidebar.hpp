#pragma once
// The panels beside the picture, one under another.
#include "panels/file_panel.hpp"
#include "panels/selection_panel.hpp"
#include "panels/widgets.hpp"

namespace deltalux::viewer {

class Sidebar {
 public:
  /// Its width, in ImGui's units: what it takes from the picture.
  static float width();
  /// At the right of the picture.
  void draw(Controller&, Tools&, const gl::Renderer&, float pictureWidth, float height);

 private:
  Pending pending_;
  TypedTurn turn_;
  FilePanel files_;
  bool explained_ = false;  // when it was drawn last there was an explanation
  std::size_t pinned_ = 0;  // and so many probes: panels open when something comes to be in them
};

}  // namespace deltalux::viewer
