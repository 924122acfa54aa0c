#pragma once
// Planar polygons in space as outlines in the plane.
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux::scene {

/// Area times normal, from coordinates relative to the first vertex. [SSS74]
Vec3 newellVector(const std::vector<Vec3>& vertices);

/// Plane coordinates by leaving the axis nearest to the normal out: numbers that were equal stay equal, and what turns
/// counter-clockwise seen from the front does so still.
std::vector<Vec2> flatOutline(const std::vector<Vec3>& vertices, const Vec3& normal);

}  // namespace deltalux::scene
