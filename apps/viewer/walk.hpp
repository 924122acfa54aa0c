#pragma once
// Walking: speeds that rise and fall smoothly, by time and not by frames.
#include <deltalux/scene.hpp>
#include <deltalux/view.hpp>

namespace deltalux::viewer {

/// What keys ask for: -1 to 1 along the camera's right, forward and up.
struct Steps {
  Vec3 rightForwardUp{0};
  bool fast = false;
};

class Walk {
 public:
  /// Moves the camera on by so many seconds. `level`: keeps its height. True where it moved.
  bool advance(View&, const Steps&, bool level, double speed, double seconds);
  bool moving() const { return moving_; }

 private:
  Vec3 velocity_{0};  // relative to the speed
  bool moving_ = false;
};

/// As a person walks; slower in scenes that one would leave after a few steps [scene units / s].
double walkingSpeed(const Scene&);

}  // namespace deltalux::viewer
