#pragma once
// The impacts on one side of a surface, placed on its charts.
#include <span>

#include "caustics/cell_light.hpp"
#include "particles/impact.hpp"

namespace deltalux {

/// By chart. The impacts' own primitive and side are not looked at.
std::vector<std::vector<ChartImpact>> placeImpacts(const Shape&, const Charts&, std::span<const Impact>);

}  // namespace deltalux
