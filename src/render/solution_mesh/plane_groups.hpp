#pragma once
// Which sides share points along their edges: polygons that lie in one plane and touch, facing the same way. Meshes and
// curved surfaces are alone.
#include <deltalux/scene.hpp>
#include <vector>

namespace deltalux::rendering {

/// Sides (SolutionMesh::side) by group, both ascending: every side of a surface with area is in one.
/// Cost: a search in a box tree a polygon.
std::vector<std::vector<std::uint32_t>> planeGroups(const Scene&);

/// Points in a group nearer than this are one [scene units].
double touchingDistance(const Scene&, const std::vector<std::uint32_t>& group);

}  // namespace deltalux::rendering
