#pragma once
// Along the lower edge of the picture: how far the light is, what is under the cursor, what was refused.
#include "tools.hpp"

namespace deltalux::viewer {

/// "settled", "stale 12 %", "solving 40 %".
std::string statusText(const Status&);
/// Height of the line, in ImGui's units.
float statusHeight();
void statusLine(Controller&, const Tools&, float pictureWidth, float pictureHeight);
/// Before there is anything to look at: what is opened, and how far that is.
void openingNotice(const Status&, const std::string& title, float width, float height);
/// What keys and mouse do.
void keyList(Tools&);

}  // namespace deltalux::viewer
