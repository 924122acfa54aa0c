#include "solution/solution.hpp"

namespace deltalux {

const Scene& SolutionView::scene() const { return solution_->scene; }
const SolveSettings& SolutionView::settings() const { return solution_->settings; }
const SolveReport& SolutionView::report() const { return solution_->report; }

}  // namespace deltalux
