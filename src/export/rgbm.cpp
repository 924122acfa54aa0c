#include "export/rgbm.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::exporting {

std::array<std::uint8_t, 4> packRgbm(const Rgb& colour) {
  const Rgb c = glm::clamp(colour / kRgbmRange, Rgb(0.0f), Rgb(1.0f));
  // The least factor that holds the largest channel: then that has the finest steps.
  const float alpha = std::clamp(std::ceil(255 * std::pow(maxChannel(c), 1 / kRgbmPower)), 1.0f, 255.0f);
  const float factor = std::pow(alpha / 255, kRgbmPower);
  const auto byte = [&](float v) { return static_cast<std::uint8_t>(std::lround(255 * std::min(v / factor, 1.0f))); };
  return {byte(c.r), byte(c.g), byte(c.b), static_cast<std::uint8_t>(alpha)};
}

Rgb unpackRgbm(const std::array<std::uint8_t, 4>& p) {
  return kRgbmRange * std::pow(float(p[3]) / 255, kRgbmPower) * Rgb(p[0], p[1], p[2]) / 255.0f;
}

}  // namespace deltalux::exporting
