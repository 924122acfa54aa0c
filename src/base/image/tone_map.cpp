// Tone mapping: one exposure, one operator on luminance, one gamut step, the sRGB curve.
// Source: [Reinhard02] (1, 2, 4). Departure: the white point is fixed at 4 and the key at 0.18, so that pictures of the
// same exposure can be compared; out-of-gamut colours are mixed with white instead of clipped per channel.
#include <algorithm>
#include <cmath>
#include <deltalux/image.hpp>
#include <numeric>

namespace deltalux {

namespace {
constexpr double kWhite = 4.0;  // luminance that becomes 1 [shown]
constexpr double kKey = 0.18;   // where automaticEv puts the log-average luminance [shown]

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

double compress(ToneOperator toneOperator, double Y) {
  switch (toneOperator) {
    case ToneOperator::Linear:
      return Y;
    case ToneOperator::Reinhard:
      return Y * (1.0 + Y / (kWhite * kWhite)) / (1.0 + Y);  // [Reinhard02 (4)]
  }
  return Y;
}

/// Mixes `c` of luminance `Y` with white of the same luminance until no channel exceeds 1.
glm::dvec3 intoGamut(const glm::dvec3& c, double Y) {
  if (Y >= 1.0) return glm::dvec3(1.0);
  const double brightest = std::max({c.r, c.g, c.b});
  if (brightest <= 1.0) return c;
  return glm::mix(glm::dvec3(Y), c, (1.0 - Y) / (brightest - Y));
}

std::array<std::uint8_t, 3> quantize(const glm::dvec3& c) {
  const auto byte = [](double v) {
    return static_cast<std::uint8_t>(std::lround(255.0 * encodeSrgb(std::clamp(v, 0.0, 1.0))));
  };
  return {byte(c.r), byte(c.g), byte(c.b)};
}
}  // namespace

std::string_view toneOperatorName(ToneOperator toneOperator) {
  return toneOperator == ToneOperator::Linear ? "linear" : "reinhard";
}

std::optional<ToneOperator> toneOperatorByName(std::string_view name) {
  for (const ToneOperator candidate : {ToneOperator::Linear, ToneOperator::Reinhard})
    if (toneOperatorName(candidate) == name) return candidate;
  return std::nullopt;
}

double encodeSrgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

double decodeSrgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double automaticEv(const Image& image) {
  std::vector<double> lit;  // log2 of luminance
  for (const Rgb& pixel : image.pixels) {
    const double Y = gray(glm::dvec3(pixel));
    if (Y > 0.0 && std::isfinite(Y)) lit.push_back(std::log2(Y));
  }
  if (lit.empty()) return 0;
  const double average = std::accumulate(lit.begin(), lit.end(), 0.0) / static_cast<double>(lit.size());
  const auto bright = lit.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(lit.size() - 1));
  std::nth_element(lit.begin(), bright, lit.end());
  const double ev = std::min(std::log2(kKey) - average, -*bright);
  return std::round(10.0 * ev) / 10.0;
}

DisplayImage toneMap(const Image& image, const ToneMapping& mapping) {
  DisplayImage display{image.width, image.height, {}};
  display.pixels.reserve(image.pixels.size());
  const double exposure = std::exp2(mapping.ev);
  for (const Rgb& pixel : image.pixels) {
    const glm::dvec3 c = exposure * glm::max(glm::dvec3(pixel), 0.0);
    const double Y = gray(c);
    if (!finite(pixel) || !(Y > 0.0)) {
      display.pixels.push_back({0, 0, 0});
      continue;
    }
    const double compressed = compress(mapping.toneOperator, Y);
    display.pixels.push_back(quantize(intoGamut(c * (compressed / Y), compressed)));
  }
  return display;
}

}  // namespace deltalux
