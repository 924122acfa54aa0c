#pragma once
// The engine orders the passes of a solve: a coarse solution first, then one as fine as the error asks, each of them
// consistent. Edits of the scene then cost what they change: what they leave as it was is not found again. [GD01 5]
#include <deltalux/edit.hpp>
#include <deltalux/progress.hpp>
#include <deltalux/solution.hpp>

namespace deltalux {

class Engine {
 public:
  /// Takes the scene over. Throws std::logic_error when the scene does not validate.
  explicit Engine(Scene, SolveSettings = {});
  /// Goes on with a solved scene, such as one from a file. The solution is taken over when nobody else holds it, and
  /// copied otherwise.
  explicit Engine(SolutionView);
  ~Engine();
  Engine(Engine&&) noexcept;
  Engine& operator=(Engine&&) noexcept;

  /// One round: a finer solution, whose light has converged. The report's `converged` says whether
  /// the target is met. Throws Interrupted (the last round's solution stands) when `progress` asks to stop.
  SolveReport step(Progress* progress = nullptr);
  /// In place of the first step: a coarser round, for something to look at soon. Steps after it lead to the same error.
  SolveReport preview(Progress* progress = nullptr);
  /// Steps until the target is met or the time is up.
  SolveReport solve(Progress* progress = nullptr);

  /// Takes an edit in, for the next update, and returns what undoes it exactly. Throws InputError (applyEdit) and is as
  /// before.
  Restore apply(const Edit&);
  /// Brings the solution to what all edits since have made of the scene: over lines what a fresh solve gives, in mesh,
  /// lines and particles to the last bit; over links that within the error target's own noise. Solves first what is not
  /// solved.
  StepReport update(Progress* progress = nullptr);

  // Motion: an object that is dragged, shown many times a second.

  /// Prepares for edits that move an object: the first of them would take that time otherwise. Unknown names do
  /// nothing.
  void select(const std::string& object);
  /// As much of an update as fits into so much time: over lines shadows follow, those first where most light comes or
  /// goes. Over links things that move are followed, for as long as it takes, but for most of the particles: a share of
  /// the links that send them is emitted again (SolveSettings::reemittedShare). What it could not do waits: the report
  /// says how much, and how much light is not yet where it would be. Frames to come go on with it, and update() ends
  /// it: the solution is then what one update() after all edits had made of it.
  StepReport frame(double milliseconds, Progress* progress = nullptr);

  /// Gives back what is kept for updates to ask, where none will come: a third of all memory, over lines. An update
  /// after it solves the scene from scratch.
  void forget();

  SolutionView solution() const;
  /// Where the light of the solution goes, as it is now: some hundred thousand rays. After an update, the solution's
  /// own report says only what is emitted.
  EnergyLedger balance() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux
