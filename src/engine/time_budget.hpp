#pragma once
// How far a solve goes when time is limited. Particles are as many as their share of it allows. Over links, what rounds
// have cost so far says which error the next can aim at: each state between rounds is consistent and can be the last.
#include <chrono>

#include "paper/link_errors.hpp"

namespace deltalux::engine {

class TimeBudget {
 public:
  /// `seconds` in all, of which some are spent already; 0: no limit.
  explicit TimeBudget(double seconds, double spent = 0) : seconds_(seconds), spentBefore_(spent) {}

  bool limited() const { return seconds_ > 0; }
  double seconds() const { return seconds_; }
  /// What particles, the mesh, and lines or links may take each.
  double share() const { return seconds_ / 3; }
  /// Whether the time is up: what is left to do is done in short.
  bool up() const { return limited() && left() < 0; }
  double left() const {
    return seconds_ - spentBefore_ - std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  /// What a round took that was expected to make `predicted` links and made `made`.
  void learn(double seconds, double predicted, double made);
  /// What a round that is predicted to make so many links takes. [s]
  double cost(double predicted) const { return secondsPerLink_ * trust_ * predicted; }
  /// The least error from `least` up to that a round can aim at in `seconds`; `from` when none below it can.
  double reach(const paper::LinkErrors&, double from, double least, double seconds) const;

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double seconds_, spentBefore_;
  double secondsPerLink_ = 0;  // made
  double trust_ = 1;           // links made to links predicted
};

}  // namespace deltalux::engine
