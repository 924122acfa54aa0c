#pragma once
// What an edit does to which sides light can reach (sides that it cannot have no elements: build.hpp). Uncovered: the
// bottom of a box that is lifted, what it stood on, the closet behind a door that opens, all sides of a thing that was
// added. Covered: the same when it is set down, so that no light leaks into what is closed again.
//
// Uncovered ones are looked for where light can have got to: at what has moved itself; along lines through the room
// that it left; and from every side so found, at what its own paths meet. A thing that moves takes its closed inside
// along, so dark sides of which every ray ends on other dark sides of what moved are left alone. Covered ones are
// looked for on what moved and within its bounds, where no ray leaves those. A side counts as reached when paths of the
// first estimate say so, as in a fresh solve. Cost: 32 rays a side that is looked at, 2048 a box that was left, and the
// paths of the sides that look as if they had changed; a count of all sides.
#include <span>

#include "hierarchy/build.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

/// Both in the order of surfaceSides().
struct CoveredSides {
  std::vector<hierarchy::SurfaceSide> uncovered;  // reached, without elements or with sleeping ones
  std::vector<hierarchy::SurfaceSide> covered;    // no longer reached, with elements
};

/// Scene and tracer as they are now; `moved`: what moved or was added; `left`: bounds of where things were.
CoveredSides coveredSides(const Scene&, const tracing::RayTracer&, const hierarchy::Elements&,
                          std::span<const PrimitiveId> moved, std::span<const Box> left);

}  // namespace deltalux::paper
