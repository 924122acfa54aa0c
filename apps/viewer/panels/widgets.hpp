#pragma once
// Sliders, colours and numbers that tell what the hand does with them: one drag of a slider is one step to undo.
#include <imgui.h>

#include <array>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
#include <string>

namespace deltalux::viewer {

/// What a hand has set and not let go of. There is one: a person has one cursor.
struct Pending {
  ImGuiID id = 0;
  std::array<float, 3> value{};
  std::array<float, 3> start{};  // before the hand came
};

/// What a hand did in this frame: Released comes once, when it lets go; `value` is what it has set by then.
enum class Held { Nothing, Changed, Released };

Held heldSlider(Pending&, const char* label, float& value, float least, float most, const char* format,
                ImGuiSliderFlags = 0);
Held heldColour(Pending&, const char* label, Rgb& value, ImGuiColorEditFlags = 0);
/// True once, when the hand lets go.
bool heldNumbers(Pending&, const char* label, Vec3& value, const char* format);

/// A slider over doubles, taken over as it moves.
bool slider(const char* label, double& value, double least, double most, const char* format, ImGuiSliderFlags = 0);

/// A line of a table of two columns: what and how much.
void row(const std::string& what, const std::string& howMuch);
/// Text that need not be read.
void quietText(const std::string&);

}  // namespace deltalux::viewer
