#pragma once
// From the irradiances of leaf patches to everything else: light is reflected at the leaves (B = rho E + tau E of the
// other side), and averaged by area on the way up; clusters sum what their surfaces send as a function of direction
// [GD01 2.1; SIL95]. The one writer of B, tolerance and cluster intensities, and of irradiance above the leaves. Means
// are over the exposed parts of leaves. Cost: linear in elements, or in what a change has touched.
#include <span>
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// Over the whole hierarchy. Returns the power by which leaf radiosities changed: sum of A |dB| per channel [W in
/// unit^2 as area].
RgbSum pull(Elements&);
/// The same of these leaves, what lies on their other sides and what stands above them; all else is as it was.
RgbSum pull(Elements&, std::span<const ElementId> leaves);
/// Adds the leaves that light on these shines through to.
void addOtherSides(const Elements&, std::vector<ElementId>& leaves);

}  // namespace deltalux::hierarchy
