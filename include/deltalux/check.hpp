#pragma once
// An updated solution held against one that was solved from scratch.
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>

namespace deltalux {

struct CheckSettings {
  std::size_t points = 2000;  // spread evenly over the area of all surfaces that light reaches
  double error = 0.0025;      // of measuring a point, relative: much less than what is to be told
};

/// Irradiance as probe() gives it in both, at points of surfaces. Differences are relative to that of `fresh`, or to a
/// thousandth of the mean where that is more: so dark, solving itself does not look. Measuring has noise of its own,
/// not the same in both where they differ: on a cabin it is most of the 95th percentile at an error of 0.01.
/// Leaves CheckReport::solveS alone. Throws Interrupted.
CheckReport compareSolutions(const SolutionView& updated, const SolutionView& fresh, const CheckSettings& = {},
                             Progress* progress = nullptr);

}  // namespace deltalux
