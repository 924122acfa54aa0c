#pragma once
#include "base/tuning.hpp"

namespace deltalux {

/// Paths that give a first idea of light, from all that send it or to all that get it together: kPilots along each of
/// their first four parameters, two of where they begin and two of whereto.
inline constexpr int kPilotPaths = tuning::kPilots * tuning::kPilots * tuning::kPilots * tuning::kPilots;

}  // namespace deltalux
