#pragma once
// From the irradiances of leaf patches to everything else: light is reflected at the leaves (B = rho E + tau E of the
// other side), and averaged by area on the way up; clusters sum what their surfaces send as a function of direction
// [GD01 2.1; SIL95]. The one writer of B, tolerance and cluster intensities, and of irradiance above the leaves. Means
// are over the exposed parts of leaves. Cost: linear in elements.
#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// Over the whole hierarchy. Returns the power by which leaf radiosities changed: sum of A |dB| per channel [W in
/// unit^2 as area].
RgbSum pull(Elements&);
/// Of marked elements alone: with every one of them, all above it is to be marked.
RgbSum pull(Elements&, std::span<const char> marked);

}  // namespace deltalux::hierarchy
