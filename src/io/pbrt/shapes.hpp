#pragma once
// pbrt's shapes, in their own coordinates.
#include <deltalux/shape.hpp>

#include "io/pbrt/colours.hpp"

namespace deltalux::io::pbrt {

/// Their front is where pbrt has the normal, without ReverseOrientation. Empty, and counted, for a shape that is not
/// read. Throws InputError.
std::vector<Shape> shapesOf(Context&, const Entity&);

}  // namespace deltalux::io::pbrt
