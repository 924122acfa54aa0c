#pragma once
// The light of leaves over their own lines alone, a few bounces of it: rough, but soon there, since nothing is built
// for it. It tells where it is dim.
#include "lines/lines.hpp"

namespace deltalux::lines {

/// By leaf [W/m2, gray]: what arrives over lines after kDimBounces of the light of `source`, but for what the brightest
/// of its lines brings, which may be chance. `rho`: gray reflectance, through and back.
std::vector<float> ownIndirect(const TracedLines&, std::span<const float> rho, std::span<const float> source);

/// What was traced, but of leaves that have lines in `more` those in their place. Both of the same leaves.
TracedLines replaced(const TracedLines&, const TracedLines& more);

}  // namespace deltalux::lines
