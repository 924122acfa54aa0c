#pragma once
// What lights are to be dimmed to for illuminances that are wanted. Light is linear in them: with a_gp what group g
// brings to point p undimmed (light_groups.hpp, probe), illuminance is sum over g of w_g a_gp.
#include <vector>

namespace deltalux {

struct Dimmed {
  std::vector<double> weights;  // by group, in [0, 1]
  std::vector<double> reached;  // by point, as the targets
};

/// The weights in [0, 1] with the least sum of squared differences between what is reached and the targets. `brings`:
/// by group, at each point, not negative; `targets`: by point. All are finite, in one unit. Where groups bring the same
/// everywhere, any of the best. By active sets [SP95]; cost: groups^3 a step, and points * groups^2.
Dimmed bestDimming(const std::vector<std::vector<double>>& brings, const std::vector<double>& targets);

}  // namespace deltalux
