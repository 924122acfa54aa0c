#pragma once
// Outlines of flat patches in the parameter plane: simple or weakly simple polygons (holes as seams), whose boundary
// integrals are exact because the two walks along a seam cancel.
#include <deltalux/math.hpp>
#include <span>
#include <vector>

namespace deltalux::hierarchy {

/// Signed area, positive counter-clockwise.
double outlineArea(std::span<const Vec2>);
/// Centroid; the vertex mean when there is no area.
Vec2 outlineCentroid(std::span<const Vec2>);
/// Whether `p` is inside, by the winding of crossings (even-odd).
bool outlineContains(std::span<const Vec2>, const Vec2& p);
/// Whether it is all of a rectangle of that area, which it lies in.
bool outlineFills(std::span<const Vec2>, double area);
/// The part with coordinate `axis` <= limit (below) or >= limit. [SH74]
std::vector<Vec2> clipOutline(std::span<const Vec2>, int axis, double limit, bool below);

}  // namespace deltalux::hierarchy
