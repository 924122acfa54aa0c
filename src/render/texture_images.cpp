// Caustic textures as pictures, for looking at them one by one.
#include <algorithm>
#include <cmath>
#include <deltalux/render.hpp>
#include <string>

#include "base/image/bitmap_font.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

constexpr int kGap = 6, kAcross = 6;                                            // [shown]
constexpr std::array<std::uint8_t, 3> kPaper{24, 24, 24}, kInk{230, 230, 230};  // [shown]

/// Letters, digits, dots and dashes of a name; the rest as underscores.
std::string fitForFile(std::string name) {
  for (char& c : name)
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '-')) c = '_';
  return name.empty() ? "surface" : name;
}

Image imageOf(const caustics::CausticTexture& t) {
  Image image;
  image.width = t.width, image.height = t.height;
  for (int y = t.height - 1; y >= 0; --y)
    for (int x = 0; x < t.width; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * t.width + x;
      image.pixels.push_back(t.areas[i] > 0 ? t.texels[i] : Rgb(-1.0f));
    }
  return image;
}

/// The picture within a square of `size`, each pixel the nearest texel.
void paste(DisplayImage& sheet, int left, int top, int size, const Image& image) {
  Image clean = image;
  for (Rgb& p : clean.pixels) p = glm::max(p, Rgb(0.0f));
  ToneMapping mapping;
  mapping.ev = automaticEv(clean);
  const DisplayImage shown = toneMap(clean, mapping);
  const double scale = double(size) / std::max(image.width, image.height);
  const int width = std::max(1, static_cast<int>(image.width * scale));
  const int height = std::max(1, static_cast<int>(image.height * scale));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int fromX = std::min(static_cast<int>(x / scale), image.width - 1);
      const int fromY = std::min(static_cast<int>(y / scale), image.height - 1);
      const std::uint8_t check = (x / 8 + y / 8) % 2 == 0 ? 70 : 50;
      const bool surface = image.at(fromX, fromY).r >= 0;
      sheet.at(left + x, top + y) = surface ? shown.at(fromX, fromY) : std::array<std::uint8_t, 3>{check, check, check};
    }
}

}  // namespace

std::vector<TextureImage> textureImages(const SolutionView& view) {
  const Solution& s = view.get();
  std::vector<TextureImage> images;
  for (const caustics::SurfaceCaustics& surface : s.caustics.surfaces) {
    const ObjectId object = s.scene[surface.primitive].object;
    const std::string name = fitForFile(object.valid() ? s.scene[object].name : "") + "-" +
                             std::to_string(surface.primitive.index()) + (surface.front ? "" : "-back");
    for (std::size_t i = 0; i < surface.textures.size(); ++i)
      images.push_back({name + "-" + std::to_string(i + 1), imageOf(surface.textures[i])});
  }
  return images;
}

DisplayImage contactSheet(const std::vector<TextureImage>& textures, int size) {
  const int count = static_cast<int>(textures.size()), across = std::clamp(count, 1, kAcross);
  const int down = std::max(1, (count + across - 1) / across);
  const int caption = kGlyphHeight + 4, cellHeight = size + caption + kGap;
  DisplayImage sheet{kGap + across * (size + kGap), kGap + down * cellHeight, {}};
  sheet.pixels.assign(static_cast<std::size_t>(sheet.width) * sheet.height, kPaper);
  for (int i = 0; i < count; ++i) {
    const int left = kGap + i % across * (size + kGap), top = kGap + i / across * cellHeight;
    const Image& image = textures[static_cast<std::size_t>(i)].image;
    paste(sheet, left, top + caption, size, image);
    const std::string text =
        std::to_string(i + 1) + "  " + std::to_string(image.width) + "x" + std::to_string(image.height);
    drawText(sheet, left, top, text, kInk);
  }
  return sheet;
}

}  // namespace deltalux
