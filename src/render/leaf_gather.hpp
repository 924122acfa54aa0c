#pragma once
// Irradiance of the leaf patches as reconstruction wants it. A link gives all of its receiver one value, its mean;
// where the receiver has been refined on, for other links' sake, that value makes blocks in the picture. Here every
// link is evaluated once more, at each leaf below its receiver and with the leaf's own normal (the local pass of
// [LTG93], with links in place of a mesh of discontinuities); links that hardly vary over their receiver keep their
// mean. Visibility stays the link's. Cost: links of a leaf and its ancestors, summed over leaves; one kernel for those
// that vary.
#include "render/leaf_irradiance.hpp"

namespace deltalux {

struct Solution;

/// By element; those of receiving leaves are filled. Direct light is the mesh's.
std::vector<LeafIrradiance> gatherAtLeaves(const Solution&);

}  // namespace deltalux
