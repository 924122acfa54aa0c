#pragma once
// Plays a script, a little every time the window has drawn. What it measures and reads it prints, one JSON object a
// line:
//   {"line": 7, "action": "drag", "frames": 40, "latency_ms": {"median", "p95", "worst"}, "draw_ms": {...},
//    "besides_ms": {...}}         latency: from an action to the frame that shows it; of it, drawing, and the rest
#include <chrono>
#include <functional>
#include <string>

#include "script.hpp"
#include "viewer.hpp"

namespace deltalux::viewer {

class ScriptDriver : public Driver {
 public:
  using Clock = std::chrono::steady_clock;
  /// `start`: from when times to the first picture count. `print`: takes lines without their end.
  ScriptDriver(Script, Clock::time_point start, std::function<void(const std::string&)> print);
  ~ScriptDriver() override;

  /// Throws InputError with the script's file and line when an action cannot be done, a reading is not what the script
  /// says, or a wait takes too long; OutputError when a file cannot be written.
  bool tick(Controller&, gl::Renderer&, const DrawReport&) override;
  void attach(Window&) override;
  /// While it only waits, what the solver finds is enough to draw for.
  bool wantsFrame() const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux::viewer
