#pragma once
// Measuring points, read for each group of lights by itself.
#include <deltalux/export.hpp>
#include <deltalux/solution_reader.hpp>

namespace deltalux::exporting {

/// Irradiance by point [W/m2]. `light` is a group's alone, at scale 1; `whole`: of all groups together, at the present
/// scales, to whose error `settings` ask. A group that brings little to a point need not be known to the same share of
/// itself: first all are measured roughly, then those points again where that error would be seen in the whole.
std::vector<Rgb> groupAtPoints(const SolutionReader& light, std::span<const ProbePoint>, std::span<const Rgb> whole,
                               const ProbeSettings& settings);

/// All points of all grids, one after the other.
std::vector<ProbePoint> pointsOf(const std::vector<PageGrid>&);

}  // namespace deltalux::exporting
