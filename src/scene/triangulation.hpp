#pragma once
// Ear clipping of weakly simple polygons: concave ones, and those whose holes are joined to the outline by seams (an
// edge walked there and back), with repeated and collinear vertices. [Meisters75; Eberly02]
//
// A corner is an ear when no edge of what is left of the polygon enters the open triangle over it. Asking edges rather
// than vertices needs no special case for the vertices that seams repeat. Outlines that cross themselves still end,
// with triangles that do not fit the outline.
//
// Cost: O(n^2) for ordinary polygons of n vertices, O(n^3) at worst.
#include <array>
#include <cstdint>
#include <deltalux/math.hpp>
#include <span>
#include <vector>

namespace deltalux::scene {

/// Counter-clockwise triangles, as indices into `outline`, which is counter-clockwise. Triangles without area are left
/// out; vertices inside straight edges are used where possible, so that neighbouring triangles share whole edges.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const Vec2> outline);

}  // namespace deltalux::scene
