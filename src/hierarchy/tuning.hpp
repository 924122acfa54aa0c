#pragma once
// The tuned constants of the hierarchy: purpose, unit, normal value, and what breaks.
#include <cstddef>
#include <cstdint>

namespace deltalux::hierarchy::tuning {

/// Surfaces that a cluster may hold without looking at their sizes. More: links to clusters err. Fewer: deep trees.
constexpr std::size_t kLeafGroups = 4;
/// Least mean free path of an element, relative to what is usual around it, of a part, relative to the mean distance of
/// what it is part of, and of a patch, in its radii: such a place is narrow. Less: slots between boards, narrow places
/// and corners fill with elements.
constexpr float kNarrowPlace = 0.5f;
/// Within which things touch, are aligned, or end, in the size of what they are parts of: what stands on a surface,
/// lines along its foot, ends of patches. Larger: splits along lines where nothing stands. Smaller: walls of scanned or
/// rounded coordinates are overlooked.
constexpr double kTouching = 0.02;
/// Least height of what a line is the foot of, in the side of a patch that it crosses most of, for the patch to be
/// split along it. Less: crooked patches around small things. More: light leaks below walls.
constexpr double kWall = 0.2;
/// Points along each parameter of a curved patch, or of a part or a cell of the sky, that bound it and tell its mean.
/// Fewer: loose bounds, normals that are off, and bright spots that are missed. More: time in the square.
constexpr int kGrid = 8;
/// Patches of the input level that one thing is worth, and faces of one at least: a mesh of no more faces may be the
/// polygons that it is made of; one that is fine has at least as many patches, but for as many faces in each, and is
/// fine where it has two. Fewer: coarse light on statues. More: time and memory for all that is of many triangles.
constexpr std::uint32_t kInputs = 128;

}  // namespace deltalux::hierarchy::tuning
