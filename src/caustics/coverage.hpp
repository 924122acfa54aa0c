#pragma once
// How much surface lies under each texel of a chart's region [unit^2]. Exact for polygons and surfaces of revolution;
// rings are sampled 8 x 8 in texels that an outline crosses, and once elsewhere; a mesh's triangles are sampled 8 x 8
// in every texel they touch, each with its own ratio of area to picture.
#include <vector>

#include "caustics/chart.hpp"
#include "caustics/region.hpp"

namespace deltalux::caustics {

/// width * height areas, row by row from the region's lower t.
std::vector<float> coveredAreas(const Shape&, const Charts&, std::size_t chart, const Region&, int width, int height);

}  // namespace deltalux::caustics
