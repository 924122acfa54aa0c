#pragma once
#include <bit>

#include "base/tuning.hpp"

namespace deltalux {

/// Cells that a sky is halved into: along height, and as many around at least. Particles and shadow rays choose of
/// them, and what is seen of it is known by them.
inline constexpr int kSkySide = tuning::kPilots;  // [defined]
/// Halvings of a sky, or of a lamp at most, into such cells.
inline constexpr int kSkyHalvings = 2 * std::countr_zero(unsigned{kSkySide});  // [defined]
static_assert(std::has_single_bit(unsigned{kSkySide}));

}  // namespace deltalux
