#pragma once
// The window's own framebuffer, around what the renderer draws into it.
#include <deltalux/image.hpp>

namespace deltalux::viewer::gl {

/// Fills the window with a grey [0, 1], and sets the viewport to (0, 0, width, height). A context must be current.
void clearWindow(int width, int height, float grey);
/// Reads back what was drawn and not shown yet.
DisplayImage windowPixels(int width, int height);

}  // namespace deltalux::viewer::gl
