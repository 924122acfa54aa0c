#pragma once
// One polygon between two things: whether every segment from the one to the other crosses it.
#include <array>
#include <span>

#include "hierarchy/element.hpp"

namespace deltalux::paper {

inline constexpr std::size_t kMostCorners = 12;  // [layout]

/// Of a box.
std::array<Vec3, 8> cornersOf(const Vec3& lower, const Vec3& upper);
/// Of what an element occupies: the outline of a flat patch, where it has few, else its box. Returns how many.
std::size_t cornersOf(const hierarchy::Elements&, hierarchy::ElementId, std::array<Vec3, kMostCorners>& out);

/// Whether the polygon of an outline in a plane (u,v; holes as seams) meets all segments between the hulls of `a` and
/// of `b`, of kMostCorners each at most. Never true when it does not.
bool separates(const hierarchy::PlaneFrame&, std::span<const Vec2> outline, std::span<const Vec3> a,
               std::span<const Vec3> b);

}  // namespace deltalux::paper
