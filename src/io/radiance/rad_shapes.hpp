#pragma once
#include <deltalux/shape.hpp>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// The shapes of a surface other than a source: one, or none when it has no area, or the triangles of a polygon that is
/// not planar. bubble, tube and cup, and sphere, cylinder and cone of negative radius, face inwards; both together
/// outwards. Throws InputError for radii of different signs and rings without a normal.
std::vector<Shape> makeShapes(const RadObject&);

}  // namespace deltalux::io::radiance
