#pragma once
// Push-pull: irradiance gathered at all levels is pushed down to the leaf patches, reflected there and averaged on the
// way up (hierarchy/pull.hpp) [GD01 2.1; SIL95]. The one writer of direct and indirect while links carry the light.
// Cost: linear in elements; parents stand before their children, so both ways are plain loops.
#include "hierarchy/element.hpp"

namespace deltalux::paper {

/// Runs over the whole hierarchy. Returns the power by which leaf radiosities changed: sum of A |dB| per channel [W in
/// unit^2 as area].
RgbSum pushPull(hierarchy::Elements&);

/// The same in the marked parts of the hierarchy alone [GD01 4.2, 5]: elements whose own gathered irradiance,
/// particles, shape or reflectance have changed. On return all is marked that was evaluated: those, what is below and
/// above them.
RgbSum pushPull(hierarchy::Elements&, std::vector<char>& marked);

}  // namespace deltalux::paper
