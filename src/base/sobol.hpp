#pragma once
// Stratified points of the unit square: Sobol's first two dimensions, a (0,2)-sequence, Owen-scrambled and shuffled by
// hashes, so that any number of independent pairs can be padded to one sample. Every power-of-two prefix is stratified.
// [Burley20; LK11]
#include <cstdint>
#include <span>

#include "base/random.hpp"

namespace deltalux {

constexpr std::uint32_t reverseBits(std::uint32_t x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Owen's nested uniform scrambling of a number whose bits stand in reverse. [Burley20, section 3]
constexpr std::uint32_t scrambleReversed(std::uint32_t x, std::uint32_t seed) {
  x += seed;
  x ^= x * 0x6c50b47cu;
  x ^= x * 0xb82f1e52u;
  x ^= x * 0xc7afe638u;
  x ^= x * 0x8d22f6e6u;
  return x;
}

/// The second dimension of the sequence, its bits in reverse: its matrix is Pascal's triangle modulo 2, which comes
/// apart into a factor for each bit of the bits' places.
constexpr std::uint32_t secondSobolReversed(std::uint32_t index) {
  std::uint32_t x = index;
  x ^= x >> 16;
  x ^= (x & 0xff00ff00u) >> 8;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xccccccccu) >> 2;
  return x ^ (x & 0xaaaaaaaau) >> 1;
}

struct UnitPair {
  double x, y;
};

/// The scrambled, shuffled sequence of a key, in [0,1)^2.
class ScrambledSobol {
 public:
  constexpr explicit ScrambledSobol(std::uint64_t key) {
    const std::uint64_t seeds = mix64(key), more = mix64(seeds);
    shuffle_ = static_cast<std::uint32_t>(seeds);
    x_ = static_cast<std::uint32_t>(seeds >> 32), y_ = static_cast<std::uint32_t>(more);
  }
  constexpr UnitPair operator()(std::uint32_t index) const {
    const std::uint32_t shuffled = reverseBits(scrambleReversed(reverseBits(index), shuffle_));
    // The first dimension is the index in reverse, so it is already as the scrambling wants it.
    const std::uint32_t x = reverseBits(scrambleReversed(shuffled, x_));
    const std::uint32_t y = reverseBits(scrambleReversed(secondSobolReversed(shuffled), y_));
    return {x * 0x1p-32, y * 0x1p-32};
  }
  /// Those from `first` on, several at a time.
  constexpr void points(std::uint32_t first, std::span<UnitPair> all) const {
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = (*this)(first + static_cast<std::uint32_t>(i));
  }

 private:
  std::uint32_t shuffle_ = 0, x_ = 0, y_ = 0;
};

/// Point `index` of the sequence of `key`.
constexpr UnitPair scrambledSobol(std::uint32_t index, std::uint64_t key) { return ScrambledSobol(key)(index); }

}  // namespace deltalux
