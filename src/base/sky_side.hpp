#pragma once
#include "base/tuning.hpp"

namespace deltalux {

/// Cells that a sky is halved into: along height, and as many around at least.
inline constexpr int kSkySide = 1 << tuning::kSkyHalvings / 2;  // [defined]

}  // namespace deltalux
