#pragma once
// Geometry of patches: from a domain on a primitive to extent, quadrature nodes and children. Flat patches are exact
// (outline clipped to the quadrant); curved ones follow their primitive's implicit parameterisation.
#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// A point of a patch with the unit normal of the patch's side.
struct PatchPoint {
  Vec3f position, normal;
};

/// The input-level patch that a patch is part of.
inline ElementId surfaceOf(const Elements& elements, ElementId patch) {
  while (elements.at(patch).depth > 0) patch = elements.at(patch).parent;
  return patch;
}

/// The point at parameters (u,v) of the patch's primitive (of its triangle, for meshes).
PatchPoint pointOn(const Elements&, const Scene&, ElementId patch, double u, double v);

/// Whether it is flat and no outline cuts anything off its rectangle of parameters.
bool fillsItsRectangle(const Elements&, ElementId patch);

/// A point of the patch from two numbers in [0,1): uniform by area.
PatchPoint samplePatch(const Elements&, const Scene&, ElementId patch, double a, double b);

/// Fills geometry, nodes, moments and reflectances of a patch whose domain, side and frame are set.
void shapePatch(Elements&, const Scene&, ElementId patch);

/// Where walls cross a flat patch that rise by a fifth of its side or more: the parameters of their feet.
struct Walls {
  std::optional<float> u, v;

  explicit operator bool() const { return u || v; }
};
Walls wallsAcross(const Elements&, const Scene&, ElementId patch);

/// Splits a leaf patch along the walls that cross it, or else into quadrants (into halves when it is long and thin), or
/// a leaf cell of a sky dome into four; a folded one unfolds (fold.hpp).
/// Children inherit light and reflectances; quadrants that miss the outline are left out. False when it cannot be
/// split.
bool subdivide(Elements&, const Scene&, ElementId element);
/// The same with each of several elements, none twice, in their order, by all threads. By element, whether it is split.
std::vector<char> subdivide(Elements&, const Scene&, std::span<const ElementId>);
/// Whether a leaf patch would be split into parts like these of other elements, which stand in a row.
bool splitsAlike(const Elements&, const Scene&, ElementId, const Elements& other, ElementId first, std::size_t count);

/// Fills a Distant element whose light and domain are set (a cell of its dome's directions, equal in solid angle).
void shapeDistant(Elements&, const Scene&, ElementId element);
/// Unit direction towards the point (a,b) in [0,1]^2 of the cell.
Vec3f directionOf(const Elements&, const Scene&, ElementId element, double a, double b);

}  // namespace deltalux::hierarchy
