#pragma once
// Connected triangles of a side that face about the same way.
#include <deltalux/solution_mesh.hpp>
#include <vector>

namespace deltalux::exporting {

/// Normal of a triangle of the side, as long as twice its area [scene units squared].
Vec3 areaNormal(const SurfaceMesh&, std::uint32_t triangle);

/// The triangles in regions that are connected over edges (of equal positions) and face within `crease` [radians] of
/// the region's first triangle; those without area join where they are met. Every triangle is in one region.
std::vector<std::vector<std::uint32_t>> regionsOf(const SurfaceMesh&, const std::vector<std::uint32_t>& triangles,
                                                  double crease);

}  // namespace deltalux::exporting
