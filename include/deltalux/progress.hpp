#pragma once
// Long work reports through a Progress and asks it whether to stop. The library never prints.
#include <string_view>

namespace deltalux {

class Progress {
 public:
  virtual ~Progress() = default;
  /// `fraction` in [0, 1] of `phase` is done. Called from one thread at a time, as often as the work likes.
  virtual void report(std::string_view phase, double fraction) = 0;
  /// True when the work should end as soon as its state is consistent (it then throws Interrupted).
  virtual bool stopRequested() const { return false; }
};

}  // namespace deltalux
