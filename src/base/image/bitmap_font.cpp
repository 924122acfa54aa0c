#include "base/image/bitmap_font.hpp"

#include <cstdint>

namespace deltalux {

namespace {
using Glyph = std::array<std::uint8_t, kGlyphHeight>;  // rows from the top, the leftmost pixel in bit 4

const Glyph* glyphOf(char character) {
  static constexpr std::array<Glyph, 10> digits{{
      {0b01110, 0b10001, 0b10001, 0b10101, 0b10001, 0b10001, 0b01110},
      {0b00100, 0b01100, 0b10100, 0b00100, 0b00100, 0b00100, 0b11111},
      {0b01110, 0b10001, 0b00001, 0b00110, 0b01000, 0b10000, 0b11111},
      {0b11111, 0b00010, 0b00100, 0b00110, 0b00001, 0b10001, 0b01110},
      {0b00010, 0b00110, 0b01010, 0b10010, 0b11111, 0b00010, 0b00010},
      {0b11111, 0b10000, 0b11110, 0b00001, 0b00001, 0b10001, 0b01110},
      {0b00110, 0b01000, 0b10000, 0b11110, 0b10001, 0b10001, 0b01110},
      {0b11111, 0b00001, 0b00010, 0b00100, 0b00100, 0b01000, 0b01000},
      {0b01110, 0b10001, 0b10001, 0b01110, 0b10001, 0b10001, 0b01110},
      {0b01110, 0b10001, 0b10001, 0b01111, 0b00001, 0b00010, 0b01100},
  }};
  static constexpr Glyph point{0, 0, 0, 0, 0, 0b01100, 0b01100};
  static constexpr Glyph k{0b10000, 0b10000, 0b10010, 0b10100, 0b11000, 0b10100, 0b10010};
  static constexpr Glyph m{0, 0, 0b11010, 0b10101, 0b10101, 0b10101, 0b10101};
  static constexpr Glyph capitalM{0b10001, 0b11011, 0b10101, 0b10101, 0b10001, 0b10001, 0b10001};
  static constexpr Glyph l{0b01100, 0b00100, 0b00100, 0b00100, 0b00100, 0b00100, 0b01110};
  static constexpr Glyph u{0, 0, 0b10001, 0b10001, 0b10001, 0b10011, 0b01101};
  static constexpr Glyph x{0, 0, 0b10001, 0b01010, 0b00100, 0b01010, 0b10001};

  if (character >= '0' && character <= '9') return &digits[static_cast<std::size_t>(character - '0')];
  switch (character) {
    case '.':
      return &point;
    case 'k':
      return &k;
    case 'm':
      return &m;
    case 'M':
      return &capitalM;
    case 'l':
      return &l;
    case 'u':
      return &u;
    case 'x':
      return &x;
    default:
      return nullptr;
  }
}

void fillSquare(DisplayImage& image, int left, int top, int size, std::array<std::uint8_t, 3> color) {
  for (int y = std::max(top, 0); y < std::min(top + size, image.height); ++y)
    for (int x = std::max(left, 0); x < std::min(left + size, image.width); ++x) image.at(x, y) = color;
}
}  // namespace

int textWidth(std::string_view text) {
  return text.empty() ? 0 : static_cast<int>(text.size()) * kGlyphAdvance - (kGlyphAdvance - kGlyphWidth);
}

void drawText(DisplayImage& image, int x, int y, std::string_view text, std::array<std::uint8_t, 3> color, int scale) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const Glyph* glyph = glyphOf(text[i]);
    if (!glyph) continue;
    const int left = x + static_cast<int>(i) * kGlyphAdvance * scale;
    for (int row = 0; row < kGlyphHeight; ++row)
      for (int column = 0; column < kGlyphWidth; ++column)
        if ((*glyph)[static_cast<std::size_t>(row)] >> (kGlyphWidth - 1 - column) & 1)
          fillSquare(image, left + column * scale, y + row * scale, scale, color);
  }
}

}  // namespace deltalux
