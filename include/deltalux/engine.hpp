#pragma once
// The engine orders the passes: coarse solution, hierarchy, and then rounds of refinement and gathering with a falling
// error, each round a consistent, converged solution.
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>

namespace deltalux {

class Engine {
 public:
  /// Takes the scene over. Throws std::logic_error when the scene does not validate.
  explicit Engine(Scene, SolveSettings = {});
  ~Engine();
  Engine(Engine&&) noexcept;
  Engine& operator=(Engine&&) noexcept;

  /// One round: refines to the next error of the schedule and settles the light. The report's `converged` says whether
  /// the target is met. Throws Interrupted (the last round's solution stands) when `progress` asks to stop.
  SolveReport step(Progress* progress = nullptr);
  /// Steps until the target is met or the time is up.
  SolveReport solve(Progress* progress = nullptr);

  SolutionView solution() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux
