#pragma once
// Faces of any number of corners as triangles.
#include <array>
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux::io {

/// Triangles of a face, as corners of it: in its plane where it has one, else a fan about its first corner.
std::vector<std::array<std::uint32_t, 3>> triangulated(const std::vector<Vec3>& outline);

/// Whether a triangle is more than a line that rounding has moved.
bool hasArea(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace deltalux::io
