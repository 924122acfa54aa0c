#pragma once
// Progress of a parallel loop: parts done are counted by all threads, reported by one at a time.
#include <mutex>
#include <string_view>

#include "base/check_interrupted.hpp"

namespace deltalux::rendering {

class WorkProgress {
 public:
  WorkProgress(Progress* progress, std::string_view phase, std::size_t parts)
      : progress_(progress), phase_(phase), parts_(parts) {}

  /// To be called before each part. Throws Interrupted when the work should end.
  void begin() const { checkInterrupted(progress_); }
  /// One part is done.
  void done() {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    progress_->report(phase_, static_cast<double>(++done_) / static_cast<double>(parts_));
  }

 private:
  Progress* progress_;
  std::string_view phase_;
  std::size_t parts_;
  std::mutex mutex_;
  std::size_t done_ = 0;
};

}  // namespace deltalux::rendering
