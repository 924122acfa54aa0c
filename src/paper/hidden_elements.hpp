#pragma once
// Elements from which none of a region is seen: each lies whole behind one opaque polygon, in its umbra.
//
// The umbra of a convex polygon for a box is where the polygon hides all of the box: beyond its plane, and within one
// plane through each edge, which touches the box on the side that lies outside the edge. It is found once a polygon,
// and told from a box by a product a plane; from the roots down, an element is asked only about umbras that its parent
// meets. Polygons that cover little of what is seen from the region have none; one that is not convex has those of its
// triangles. Cost: some nanoseconds a polygon around the region, some hundred an element asked.
#include "hierarchy/element.hpp"

namespace deltalux::paper {

struct HiddenElement {
  hierarchy::ElementId element;
  hierarchy::ElementId occluder;  // a flat patch of the input level
};

/// The topmost elements of the scene's trees that are known to be hidden from `region`, down to little parts of
/// surfaces, each with what hides it. What lies in the region hides nothing.
std::vector<HiddenElement> hiddenElements(const hierarchy::Elements&, const Scene&, const Box& region);

}  // namespace deltalux::paper
