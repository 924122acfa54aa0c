#pragma once
// Outlines whose holes are joined to them by seams, with every loop turned as the area integrals and the triangulation
// need it: the solid part on the left. Files wind holes either way, since what is solid is a matter of the parity of
// crossings [Radiance reference manual, "polygon"], and that depends on the edges alone.
//
// The walk is cut into loops at the points that it passes again; seams become loops of two corners and no area. A loop
// inside an even number of others must turn counter-clockwise, one inside an odd number clockwise. Those that turn the
// other way are walked backwards, from the point where the walk enters them and with all that hangs on them.
//
// Cost: O(n log n) without repeated points, else O(loops * n) at most.
#include <cstdint>
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux::scene {

/// The order in which to walk the vertices of `outline`, which as a whole is counter-clockwise; their own order when
/// nothing has to be turned.
std::vector<std::uint32_t> windingOrder(const std::vector<Vec2>& outline);

/// The same for a planar, or nearly planar, polygon in space.
std::vector<std::uint32_t> windingOrder(const std::vector<Vec3>& vertices);

/// Puts `vertices` into the order of their indices in `order`.
template <class T>
std::vector<T> inOrder(const std::vector<T>& vertices, const std::vector<std::uint32_t>& order) {
  std::vector<T> ordered;
  ordered.reserve(order.size());
  for (const std::uint32_t i : order) ordered.push_back(vertices[i]);
  return ordered;
}

}  // namespace deltalux::scene
