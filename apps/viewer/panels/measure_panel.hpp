#pragma once
// Light in numbers: under the cursor, at pinned probes, over a rectangle; and why it is bright somewhere.
#include "tools.hpp"

namespace deltalux::viewer {

void underCursorPanel(const Controller&);
void probePanel(Controller&);
void fieldPanel(Controller&, Tools&);
void explanationPanel(Controller&);
/// Names and readings at their places over the picture.
void measureMarks(const Controller&, const Tools&, const Frame&, float scale);

}  // namespace deltalux::viewer
