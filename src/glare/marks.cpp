// The fisheye picture with its sources tinted and numbered, and rings about luminaires.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/image/bitmap_font.hpp"
#include "glare/fisheye.hpp"

namespace deltalux {

namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr std::array<Colour, 6> kSourceTints{
    {{230, 60, 50}, {245, 160, 20}, {250, 230, 60}, {60, 190, 230}, {150, 110, 240}, {240, 110, 190}}};  // [shown]
constexpr Colour kRing{40, 220, 110}, kPaper{24, 24, 24}, kInk{255, 255, 255}, kShadow{0, 0, 0};         // [shown]
constexpr double kSourceTint = 0.5;  // share of the tint [shown]
constexpr int kRingMargin = 4;       // about a luminaire [px] [shown]

class Marker {
 public:
  Marker(const DaylightGlare& glare, DisplayImage& image) : glare_(glare), image_(image) {}

  Vec2 place(const Vec3& towards) const {
    const Vec2 p = fisheyePlace(glare_.eye, towards);
    return {0.5 * (1 + p.x) * image_.width, 0.5 * (1 - p.y) * image_.height};
  }
  void ring(const Vec3& towards, double solidAngle, const Colour& colour) {
    const Vec2 middle = place(towards);
    const double radius = radiusOf(solidAngle) + kRingMargin;
    const int steps = static_cast<int>(std::ceil(4 * kPi * radius));
    for (int i = 0; i < steps; ++i)
      for (const double wider : {0.0, 1.0}) {
        const double a = 2 * kPi * i / steps;
        dot(middle + (radius + wider) * Vec2(std::cos(a), std::sin(a)), colour);
      }
  }
  /// Beside the source, away from the middle of the picture.
  void label(const GlareSource& source, std::size_t number) {
    const std::string text = fmt::format("{}", number);
    const int scale = std::max(1, image_.width / 220);
    const double outwards = place(source.direction).x < 0.5 * image_.width ? -1 : 1,
                 off = radiusOf(source.solidAngle) + 0.5 * scale * textWidth(text) + kRingMargin;
    const Vec2 at = place(source.direction) + Vec2(outwards * off, 0);
    const int x = std::clamp(static_cast<int>(at.x) - scale * textWidth(text) / 2, 2,
                             image_.width - scale * textWidth(text) - 2),
              y = static_cast<int>(at.y) - scale * kGlyphHeight / 2;
    for (const int dx : {-1, 1})
      for (const int dy : {-1, 1}) drawText(image_, x + dx, y + dy, text, kShadow, scale);
    drawText(image_, x, y, text, kInk, scale);
  }
  void cross() {
    const int arm = image_.width / 64;
    for (int i = -arm; i <= arm; ++i)
      for (const Vec2 d : {Vec2(i, 0), Vec2(0, i)}) dot(0.5 * Vec2(image_.width, image_.height) + d, kInk);
  }

 private:
  /// Of a disc of that solid angle [px].
  double radiusOf(double solidAngle) const { return std::sqrt(solidAngle / kPi) / kPi * image_.width; }
  void dot(const Vec2& p, const Colour& colour) {
    const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
    if (x >= 0 && y >= 0 && x < image_.width && y < image_.height) image_.at(x, y) = colour;
  }

  const DaylightGlare& glare_;
  DisplayImage& image_;
};

}  // namespace

DisplayImage markGlare(const DaylightGlare& glare, const UnifiedGlare* luminaires) {
  DisplayImage image = toneMap(glare.picture, {ToneOperator::Reinhard, automaticEv(glare.picture)});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      Colour& pixel = image.at(x, y);
      const int source = glare.sourceOf[static_cast<std::size_t>(y * image.width + x)];
      if (!glare::fisheyePixel(glare.eye, image.width, x, y)) pixel = kPaper;
      if (source < 0) continue;
      const Colour& tint = kSourceTints[static_cast<std::size_t>(source) % kSourceTints.size()];
      for (std::size_t c = 0; c < 3; ++c)
        pixel[c] = static_cast<std::uint8_t>(std::lround((1 - kSourceTint) * pixel[c] + kSourceTint * tint[c]));
    }
  Marker marker(glare, image);
  marker.cross();
  if (luminaires)
    for (const LuminaireSeen& l : luminaires->luminaires) marker.ring(l.source.direction, l.source.solidAngle, kRing);
  const int inPicture = glare.sourceOf.empty() ? -1 : std::ranges::max(glare.sourceOf);
  for (std::size_t i = 0; i < glare.sources.size(); ++i) {
    const GlareSource& s = glare.sources[i];
    if (static_cast<int>(i) > inPicture) marker.ring(s.direction, s.solidAngle, kSourceTints[i % kSourceTints.size()]);
    marker.label(s, i + 1);
  }
  return image;
}

}  // namespace deltalux
