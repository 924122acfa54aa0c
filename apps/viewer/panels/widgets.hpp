#pragma once
// Sliders, colours and numbers that are taken over once the hand lets go: one drag of a slider is one step to undo.
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
};

/// All return true once, when the hand lets go; `value` is then what it has set.
bool heldSlider(Pending&, const char* label, float& value, float least, float most, const char* format,
                ImGuiSliderFlags = 0);
bool heldColour(Pending&, const char* label, Rgb& value, ImGuiColorEditFlags = 0);
bool heldNumbers(Pending&, const char* label, Vec3& value, const char* format);

/// A slider over doubles, taken over as it moves.
bool slider(const char* label, double& value, double least, double most, const char* format, ImGuiSliderFlags = 0);

/// A line of a table of two columns: what and how much.
void row(const std::string& what, const std::string& howMuch);
/// Text that need not be read.
void quietText(const std::string&);

}  // namespace deltalux::viewer
