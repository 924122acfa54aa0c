#pragma once
#include <chrono>

namespace deltalux::engine {

/// Wall-clock time.
class Clock {
 public:
  /// Since it was made.
  double seconds() const { return since(start_); }
  /// Since the last lap, or since it was made.
  double lap() {
    const double seconds = since(lap_);
    lap_ = std::chrono::steady_clock::now();
    return seconds;
  }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static double since(Time start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  Time start_ = std::chrono::steady_clock::now(), lap_ = start_;
};

}  // namespace deltalux::engine
