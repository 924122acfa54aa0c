#pragma once
// The light of leaves over their own lines alone, a few bounces of it: rough, but soon there, since nothing is built
// for it. It tells where it is dim.
#include "lines/lines.hpp"

namespace deltalux::lines {

/// By leaf [W/m2, gray]: what arrives over its first `counts` lines, which it has, after kDimBounces of the light of
/// `source`, but for what the brightest of its lines brings, which may be chance. `rho`: gray reflectance, through and
/// back.
std::vector<float> ownIndirect(const Lines&, const hierarchy::LeafTable&, std::span<const std::uint32_t> counts,
                               std::span<const float> rho, std::span<const float> source);

}  // namespace deltalux::lines
