#pragma once
// What the renderer's passes take for granted of OpenGL, while it lives; then the framebuffer and the viewport are
// those of before, and all that was turned on is off.
#include "gl/objects.hpp"

namespace deltalux::viewer::gl {

class DrawState {
 public:
  DrawState();
  ~DrawState();
  DrawState(const DrawState&) = delete;
  DrawState& operator=(const DrawState&) = delete;

  /// That was bound for drawing.
  GLuint framebuffer() const { return static_cast<GLuint>(framebuffer_); }

 private:
  GLint framebuffer_ = 0, viewport_[4] = {};
};

/// Turns the six planes of a section on or off.
void cutAtSection(bool on);

}  // namespace deltalux::viewer::gl
