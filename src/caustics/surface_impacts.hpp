#pragma once
// The impacts on one side of a surface, placed on its charts.
#include <span>

#include "caustics/cell_light.hpp"
#include "particles/impact.hpp"

namespace deltalux::caustics {

/// By chart. The impacts' own primitive and side are not looked at.
std::vector<std::vector<ChartImpact>> placeImpacts(const Shape&, const Charts&, std::span<const particles::Impact>);

}  // namespace deltalux::caustics
