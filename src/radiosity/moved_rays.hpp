#pragma once
// Which rays of a row what moves can touch.
#include <span>
#include <vector>

#include "paper/space_change.hpp"
#include "radiosity/ray_code.hpp"
#include "radiosity/row_reach.hpp"

namespace deltalux::radiosity {

/// Whether any of what the rays of a leaf's row pass through, end at, or would.
inline bool meets(const paper::SpaceChange& space, const hierarchy::ElementGeometry& leaf, const RowReach& reach) {
  return space.meets(reach.objects) ||
         (!space.empty() && reach.meets(leaf, space.bounds().lower, space.bounds().upper));
}

/// Of each of many rays of a leaf: appends the indices of those that something moving may touch.
void meetsRays(const paper::SpaceChange&, const hierarchy::ElementGeometry& from, std::span<const RayCode>,
               std::vector<std::uint32_t>& out);

}  // namespace deltalux::radiosity
