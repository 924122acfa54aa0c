#include "export/rgb9e5.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::exporting {

namespace {

constexpr int kMantissaBits = 9, kBias = 15, kGreatestExponent = 31;  // [layout]
constexpr std::uint32_t kMantissaMask = (1u << kMantissaBits) - 1;    // [layout]
constexpr float kGreatest = 65408.0f;                                 // 511 / 512 * 2^16 [layout]

float clean(float v) { return v > 0.0f ? std::min(v, kGreatest) : 0.0f; }

float unitOf(int exponent) { return std::ldexp(1.0f, exponent - kBias - kMantissaBits); }

}  // namespace

std::uint32_t packRgb9e5(const Rgb& value) {
  const Rgb c(clean(value.r), clean(value.g), clean(value.b));
  const float most = maxChannel(c);
  if (!(most > 0.0f)) return 0;
  int exponent = std::clamp(std::ilogb(most) + 1 + kBias, 0, kGreatestExponent);
  if (std::lround(most / unitOf(exponent)) > long(kMantissaMask)) ++exponent;
  const float unit = unitOf(exponent);
  const auto mantissa = [&](float v) { return static_cast<std::uint32_t>(std::lround(v / unit)); };
  return static_cast<std::uint32_t>(exponent) << (3 * kMantissaBits) | mantissa(c.b) << (2 * kMantissaBits) |
         mantissa(c.g) << kMantissaBits | mantissa(c.r);
}

Rgb unpackRgb9e5(std::uint32_t word) {
  const float unit = unitOf(static_cast<int>(word >> (3 * kMantissaBits)));
  const auto channel = [&](int i) { return unit * static_cast<float>(word >> (i * kMantissaBits) & kMantissaMask); };
  return Rgb(channel(0), channel(1), channel(2));
}

}  // namespace deltalux::exporting
