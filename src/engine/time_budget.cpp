#include "engine/time_budget.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"

namespace deltalux::engine {

void TimeBudget::learn(double seconds, double predicted, double made) {
  if (made > 0) secondsPerLink_ = seconds / made;
  if (predicted > 0) trust_ = std::clamp(made / predicted, 0.05, 20.0);
}

double TimeBudget::reach(const paper::LinkErrors& errors, double from, double least, double seconds) const {
  double error = from;
  while (error > least) {
    const double next = std::max(least, error * std::exp2(-deltalux::tuning::kOctaveStep));
    if (cost(errors.madeBy(next)) > seconds) break;
    error = next;
  }
  return error;
}

}  // namespace deltalux::engine
