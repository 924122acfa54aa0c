#pragma once
// How much light a patch may be given back of what it sends before light between such patches would grow without end.
#include <algorithm>

#include "base/tuning.hpp"
#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// Irradiance per radiosity of all around, of which a patch sends back a little less than there is.
inline float mostReturned(const ElementLight& light) {
  return (1 - deltalux::tuning::kNegligible) / std::max(maxChannel(light.rho + light.tau), 1e-3f);
}

}  // namespace deltalux::hierarchy
