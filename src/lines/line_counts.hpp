#pragma once
// How many lines each leaf gets: a base that follows from the error, times the root of what the leaf is of area and of
// power, whichever is more, in octaves at thresholds of its own, so that small changes leave nearly all leaves' lines
// as they are.
#include "hierarchy/leaf_table.hpp"

namespace deltalux::lines {

/// Lines of a leaf of mean area and power.
std::uint32_t baseLines(double error);

/// By leaf; `power`: what each sends of its sources' light [W, gray]. None where `enclosed`, by element of the input
/// level.
std::vector<std::uint32_t> lineCounts(const hierarchy::Elements&, const hierarchy::LeafTable&,
                                      std::span<const float> power, const std::vector<char>& enclosed,
                                      std::uint32_t base);

}  // namespace deltalux::lines
