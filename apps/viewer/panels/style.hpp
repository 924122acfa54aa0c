#pragma once
// How panels look: dark and calm, so that the picture is what one looks at.
#include <imgui.h>

namespace deltalux::viewer {

/// Colours and sizes of ImGui's current context, and a font that can be read. `scale`: of the screen, 1 at 96 dots an
/// inch.
void applyStyle(float scale);

/// Of text and marks, beside ImGui's own.
namespace ink {
inline const ImVec4 kCalm{0.55f, 0.75f, 0.62f, 1};   // all is well
inline const ImVec4 kBusy{0.93f, 0.76f, 0.42f, 1};   // light is on its way
inline const ImVec4 kError{0.95f, 0.52f, 0.45f, 1};  // something was refused
inline const ImVec4 kQuiet{0.62f, 0.63f, 0.65f, 1};  // what need not be read
}  // namespace ink

/// Of x, y and z, wherever axes are drawn. `strong`: under the cursor.
ImU32 axisColour(int axis, bool strong);

}  // namespace deltalux::viewer
