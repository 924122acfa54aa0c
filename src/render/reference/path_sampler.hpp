#pragma once
// The random numbers of one path: stratified over a batch of paths for the first decisions, independent afterwards.
// Batches are independent of each other, so their means give an honest standard error.
#include <deltalux/math.hpp>

#include "base/random.hpp"
#include "base/sobol.hpp"
#include "base/tuning.hpp"

namespace deltalux::rendering {

class PathSampler {
 public:
  /// Path `index` of the batch `key`.
  PathSampler(std::uint64_t key, std::uint32_t index) : key_(key), index_(index), rng_(key, index) {}

  Vec2 next2() {
    if (dimension_ >= kStratified) return {rng_.uniform(), rng_.uniform()};
    const UnitPair p = scrambledSobol(index_, combineKeys(key_, ++dimension_));
    return {p.x, p.y};
  }
  double next1() { return next2().x; }

 private:
  // Of a connection two, of a scattering two, and the roulette's.
  static constexpr std::uint64_t kStratified = 5 * deltalux::tuning::kPilotBounces;  // [defined]

  std::uint64_t key_;
  std::uint32_t index_;
  std::uint64_t dimension_ = 0;
  Rng rng_;
};

}  // namespace deltalux::rendering
