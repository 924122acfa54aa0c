#pragma once
// Along which ways particles came to a point: those deposited nearest to it, grouped by the surfaces that they
// met.
#include <deltalux/contributions.hpp>

#include "render/light_meter.hpp"

namespace deltalux::rendering {

/// The groups' shares of `light` [W/m2], which is what all particles bring there; in falling order.
std::vector<Contributions::Path> particlePathsAt(const Solution&, const SurfaceSpot&, const Rgb& light);

}  // namespace deltalux::rendering
