#pragma once
// Push-pull: irradiance gathered at all levels is pushed down to the leaf patches, reflected there (B = rho E + tau E
// of the other side), and averaged by area on the way up; clusters sum what their surfaces send as a function of
// direction [GD01 2.1; SIL95]. The one writer of B, tolerance and cluster intensities; of direct and indirect
// while links are refined, and above the leaves once rows of transfers fill those (leaf_transfers.hpp). Means are over
// the exposed parts of leaves (exposure.hpp). Cost: linear in elements; parents stand before their children, so both
// ways are plain loops; or in what a change has touched.
#include <span>
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::radiosity {

/// Runs over the whole hierarchy. Returns the power by which leaf radiosities changed: sum of A |dB| per channel [W in
/// unit^2 as area].
RgbSum pushPull(hierarchy::Elements&);

/// The upward half alone: from the irradiances that the leaves have, everything above. Returns as pushPull.
RgbSum pull(hierarchy::Elements&);
/// The same of these leaves, what lies on their other sides and what stands above them; all else is as it was.
RgbSum pull(hierarchy::Elements&, std::span<const hierarchy::ElementId> leaves);
/// Adds the leaves that light on these shines through to.
void addOtherSides(const hierarchy::Elements&, std::vector<hierarchy::ElementId>& leaves);

}  // namespace deltalux::radiosity
