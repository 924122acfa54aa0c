#pragma once
// Pictures: linear light per pixel, and how it becomes something a screen can show.
#include <array>
#include <cstdint>
#include <deltalux/units.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux {

/// Radiance [W/(sr m2)] per pixel, or irradiance [W/m2] where a function says so. Rows run from the top, pixels from
/// the left; pixels.size() is width * height.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
  double exposure = 1;  // what a .hdr file's stored values are multiplied by; `pixels` never are
  std::string view;     // Radiance view options ("-vtv -vp 0 0 1 ..."), empty when unknown
  double luminousEfficacy = kLuminousEfficacy;  // of the scene that it shows [lm/W]

  Rgb& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const Rgb& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// Eight bits per channel, sRGB-encoded, laid out like Image.
struct DisplayImage {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;

  std::array<std::uint8_t, 3>& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const std::array<std::uint8_t, 3>& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

/// How scene luminance is compressed to the screen's range. With Y the luminance after exposure:
///   Linear    Y as it is, clipped at 1.
///   Reinhard  Y (1 + Y / 16) / (1 + Y): 1 is reached at Y = 4. [Reinhard02 (4)]
/// Both keep the ratio of the channels until one exceeds 1; then the colour is mixed with white at constant luminance.
enum class ToneOperator { Linear, Reinhard };

/// The operator's name on command lines, and back; nullopt for an unknown name.
std::string_view toneOperatorName(ToneOperator);
std::optional<ToneOperator> toneOperatorByName(std::string_view name);

struct ToneMapping {
  ToneOperator toneOperator = ToneOperator::Reinhard;
  double ev = 0;  // exposure in stops: radiance is multiplied by 2^ev, so at 0 a radiance of 1 W/(sr m2) is Y = 1
};

/// The picture for a screen. Radiance's primaries are shown as sRGB's (they differ by 0.01 in one coordinate of green;
/// equal energy becomes the screen's white). Pixels that are not finite turn black.
DisplayImage toneMap(const Image&, const ToneMapping& = {});

/// The exposure that puts the log-average luminance of the lit pixels at 0.18 [Reinhard02 (1, 2)], or a lower one that
/// keeps nine tenths of them at 1 or below (small bright things in dark surroundings); in tenths of a stop, 0 for
/// black.
double automaticEv(const Image&);

/// sRGB transfer function [IEC 61966-2-1], [0,1] -> [0,1].
double encodeSrgb(double linear);
/// Its inverse.
double decodeSrgb(double encoded);

struct FalseColorSettings {
  double top = 0;  // upper end of the scale [lux]; 0: the picture's 99.5th percentile, rounded up to 1, 2, 5, 10 ...
  double decades = 3;  // the scale is logarithmic, from top / 10^decades to top
};

/// An irradiance picture [W/m2] in colours that stand for illuminance [lux], with a legend of the scale added at the
/// left. Pixels that see no surface (negative or not finite) are grey, pixels below the scale have its lowest colour.
DisplayImage falseColor(const Image& irradiance, const FalseColorSettings& = {});

}  // namespace deltalux
