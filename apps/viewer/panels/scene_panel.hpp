#pragma once
// What is shown of the scene: section box, bookmarks, overlays, and what drawing and solving took.
#include "tools.hpp"

namespace deltalux::viewer {

void viewPanel(Controller&, Tools&);
void sectionPanel(Controller&);
void overlayPanel(Controller&);
/// Times, bytes and counts over the picture.
void statistics(const Controller&, const DrawReport&, float pictureWidth);

}  // namespace deltalux::viewer
