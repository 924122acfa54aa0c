#pragma once
#include "hierarchy/element.hpp"

namespace deltalux::paper {

/// Whether a patch surely turns its back on all of a box: n.(x - y) <= 0 for every point y of its box, every normal n
/// of its cone and every point x of the other's box. Then nothing passes from one to the other, whatever stands between
/// them. Never true when some point has some other in front of it. Exact for flat patches and boxes along the axes.
bool turnsAway(const hierarchy::ElementGeometry& patch, const hierarchy::ElementGeometry& from);

}  // namespace deltalux::paper
