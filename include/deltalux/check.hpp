#pragma once
// An updated solution held against one that was solved from scratch.
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>

namespace deltalux {

/// Irradiance as probe() gives it in both, at `points` points spread evenly over the area of all surfaces that light
/// reaches. Differences are relative to that of `fresh`, or to a thousandth of the mean where that is more: so dark,
/// solving itself does not look. Leaves CheckReport::solveS alone. Throws Interrupted.
CheckReport compareSolutions(const SolutionView& updated, const SolutionView& fresh, std::size_t points = 2000,
                             Progress* progress = nullptr);

}  // namespace deltalux
