#pragma once
// Outlines that pass one point several times, put in an order without crossings.
//
// Where seams to several holes start from one vertex, files give them in any order, and a walk that takes them out of
// turn crosses itself there. At each such point the passes are joined anew: who comes in along an edge leaves by the
// outgoing edge next to it on the inner (left) side. Edges stay the same, and so does what they enclose.
//
// Cost: O(n log n), and O(k^2) at a point passed k times.
#include <cstdint>
#include <deltalux/math.hpp>
#include <span>
#include <vector>

namespace deltalux::scene {

/// Closed walks (indices into `outline`, which is counter-clockwise) over all edges, each free of crossings at its
/// repeated points: one, unless the outline only touches itself there. The outline as it is, when that cannot be had.
std::vector<std::vector<std::uint32_t>> outlineLoops(std::span<const Vec2> outline);

}  // namespace deltalux::scene
