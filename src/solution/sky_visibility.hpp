#pragma once
// How open the sky is about each leaf of a solution, by all the lines that were traced below a common element; without
// lines, alike everywhere.
#include "direct/sky_light.hpp"
#include "lines/lines.hpp"

namespace deltalux {

direct::SkyVisibility skyVisibility(const hierarchy::Elements&, const hierarchy::LeafTable&, const lines::Lines&);

}  // namespace deltalux
