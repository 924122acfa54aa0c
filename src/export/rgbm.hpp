#pragma once
// Colours in 8-bit RGBM: three channels times a shared factor in alpha, as MX_lightmap has them. [MX_lightmap]
#include <array>
#include <cstdint>
#include <deltalux/units.hpp>

namespace deltalux::exporting {

constexpr float kRgbmRange = 34.49f;  // what RGBM of all ones stands for: rgb * kRgbmRange * alpha^kRgbmPower [defined]
constexpr float kRgbmPower = 2.2f;    // [defined]

/// Channels in [0, kRgbmRange]; others are clipped. To 0.4 % of the largest channel where that is above 1e-4 of the
/// range.
std::array<std::uint8_t, 4> packRgbm(const Rgb&);
Rgb unpackRgbm(const std::array<std::uint8_t, 4>&);

}  // namespace deltalux::exporting
