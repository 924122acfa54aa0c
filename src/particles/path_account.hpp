#pragma once
// What became of a path's flux, kept in 17 bytes, so that accounts can be made with whatever its sender sends at the
// time. Colours share an exponent and are rounded by chance: right in the mean, however many are summed.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <deltalux/units.hpp>

namespace deltalux::particles {

/// Three channels in four bytes: a byte each, and a power of two.
class PackedRgb {
 public:
  PackedRgb() = default;
  /// `chance`: any bits.
  PackedRgb(const Rgb& c, std::uint32_t chance) {
    const float most = std::max({std::abs(c.r), std::abs(c.g), std::abs(c.b)});
    if (!(most > 0x1p-100f) || !(most < 0x1p100f)) return;
    // 126: channels may be negative, and the largest may be rounded up.
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(most / 126.0f) >> 23) - 126;
    const float unit = powerOfTwo(-exponent);
    for (int i = 0; i < 3; ++i) {
      const float at = c[i] * unit;
      const float low = std::floor(at), dither = static_cast<float>(chance >> (8 * i) & 255u) / 256.0f;
      mantissa_[i] = static_cast<std::int8_t>(low + (at - low > dither ? 1.0f : 0.0f));
    }
    exponent_ = static_cast<std::int8_t>(exponent);
  }

  Rgb value() const { return Rgb(mantissa_[0], mantissa_[1], mantissa_[2]) * powerOfTwo(exponent_); }

 private:
  static float powerOfTwo(int n) { return std::bit_cast<float>(static_cast<std::uint32_t>(n + 127) << 23); }

  std::int8_t mantissa_[3] = {0, 0, 0}, exponent_ = 0;
};

/// Throughput, before the link's scale. Entered + passed = deposited + absorbed + left, but for roulette.
struct PathAccount {
  PackedRgb entered;   // taken from the light around: at a first surface that takes no particles
  PackedRgb passed;    // passed on by surfaces that take particles: of the light that lands there, whatever by
  PackedRgb absorbed;  // by media, and by surfaces that take no particles
  PackedRgb left;      // left the scene, or was cut by the depth limit
};

/// What befell a path.
enum PathTermination : std::uint8_t {
  kArrived = 1,   // at a receiver of its link
  kFirstEnd = 2,  // its first segment ends on what it met first
  kCut = 4,       // by the depth limit
};

}  // namespace deltalux::particles
