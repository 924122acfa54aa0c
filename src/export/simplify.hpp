#pragma once
// A page's mesh without the vertices that its light can do without. The solver's mesh is fine where light is uncertain,
// and its patches are fans about their middles; where light between the neighbours is what a vertex has, for every
// group of lights, nobody sees the vertex.
//
// A vertex inside of a side is drawn into a neighbour (a half-edge collapse) when each vertex that was there, this one
// and those that went before it, keeps its light within the tolerance, and its place: in its plane, or on a curved
// surface within 0.3 % of its size. Outlines of sides stay as they are, so sides that touch do so
// still.
// Cost: some microseconds a vertex; sides in parallel.
#include <vector>

#include "export/page_mesh.hpp"

namespace deltalux::exporting {

/// What interpolation may be off by: `relative` of a group's light at the point, or kFaint of that of all light there
/// if that is more.
struct LightTolerance {
  double relative = 0.01;
  std::vector<double> floors = {};  // by group: light below it is not told more finely [W/m2, gray]; empty: 0
};

/// Leaves vertices out of the mesh and of `layers`, which are by group and vertex [W/m2]. `whole`: by side of the page,
/// those that stay as they are; empty: none.
void simplify(PageMesh&, std::vector<std::vector<Rgb>>& layers, const LightTolerance&,
              const std::vector<char>& whole = {});

/// Sides that caustic textures lie on and that are not flat: both have to keep to one shape.
std::vector<char> sidesUnderTextures(const PageMesh&, const std::vector<SolutionMesh>& groups);

}  // namespace deltalux::exporting
