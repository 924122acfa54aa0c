#pragma once
// Counter-based random numbers: a sample depends on what it is for (key) and its number, never on the order of
// evaluation, so results do not depend on the thread count and more samples extend the same prefix.
#include <cstdint>

namespace deltalux {

/// A bijective mix of 64 bits (the finaliser of SplitMix64; Steele, Lea, Flood 2014).
constexpr std::uint64_t mix64(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

constexpr std::uint64_t combineKeys(std::uint64_t a, std::uint64_t b) { return mix64(a ^ mix64(b)); }

/// Uniform in [0,1) from the upper bits.
constexpr double toUnit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }
constexpr float toUnitFloat(std::uint64_t bits) { return static_cast<float>(bits >> 40) * 0x1p-24f; }

/// The random sequence of one key.
class Rng {
 public:
  constexpr explicit Rng(std::uint64_t key) : key_(mix64(key)) {}
  constexpr Rng(std::uint64_t key, std::uint64_t index) : key_(combineKeys(key, index)) {}

  constexpr std::uint64_t bits() { return mix64(key_ + 0x9e3779b97f4a7c15ull * counter_++); }
  constexpr double uniform() { return toUnit(bits()); }

 private:
  std::uint64_t key_;
  std::uint64_t counter_ = 0;
};

}  // namespace deltalux
