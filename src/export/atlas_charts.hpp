#pragma once
// The triangles of a side laid flat, in charts: a flat side is one, curved shapes are unrolled over their parameters,
// meshes are cut where they bend. In a chart no two triangles overlap, and its longest edges run along the axes, so
// that rectangles end at texel centres (atlas_layout.hpp).
//
// A mesh is cut into connected regions whose triangles face within an angle of the first one's normal; each is
// projected along its mean normal. A region that still covers itself is cut into its planes, and if need be into its
// triangles. Cost: n log n in the triangles of the side.
#include <deltalux/solution_mesh.hpp>
#include <vector>

namespace deltalux::exporting {

struct AtlasChart {
  std::uint32_t side = 0;                // SolutionMesh::side
  std::vector<std::uint32_t> triangles;  // numbers of the side's triangles, ascending
  std::vector<std::uint32_t> vertices;   // of the side, ascending
  std::vector<Vec2> places;              // by vertices [scene units]; the least coordinates are 0
  std::vector<std::uint32_t> corners;    // three per triangle, into vertices
  int group = 0;                         // charts of different groups lie on different pages
  Vec2 size{0};                          // largest coordinates [scene units]
};

/// Every triangle of the side is in one chart. `crease` [radians], below pi / 2: how far the triangles of a region may
/// turn from its first one.
std::vector<AtlasChart> chartsOf(const SurfaceMesh&, const Shape&, double crease);

/// Whether triangles of the chart cover each other by more than rounding.
bool coversItself(const AtlasChart&);

}  // namespace deltalux::exporting
