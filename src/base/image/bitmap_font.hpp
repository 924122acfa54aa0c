#pragma once
// Captions inside pictures: digits and a few letters, 5 x 7 pixels each, drawn by us.
#include <deltalux/image.hpp>
#include <string_view>

namespace deltalux {

inline constexpr int kGlyphWidth = 5, kGlyphHeight = 7, kGlyphAdvance = 6;  // [shown]

/// Width in pixels of `text` at scale 1.
int textWidth(std::string_view text);

/// Draws `text` with its top left corner at (x, y), every glyph pixel as a square of `scale` pixels. Parts outside the
/// picture are left out; characters without a glyph leave a gap.
void drawText(DisplayImage&, int x, int y, std::string_view text, std::array<std::uint8_t, 3> color, int scale = 1);

}  // namespace deltalux
