#include "solver_mail.hpp"

#include <chrono>
#include <cmath>

namespace deltalux::viewer {

Orders SolverInbox::take(double patience) {
  std::unique_lock lock(mutex_);
  const auto called = [&] { return filled_ || stopped_; };
  if (std::isinf(patience))
    wake_.wait(lock, called);
  else if (patience > 0)
    wake_.wait_for(lock, std::chrono::duration<double>(patience), called);
  filled_ = false;
  Orders next;
  next.editCount = orders_.editCount, next.pinned = orders_.pinned;
  return std::exchange(orders_, std::move(next));
}

void SolverInbox::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  wake_.notify_one();
}

std::vector<PixelSample> SolverOutbox::takeSamples() {
  const std::lock_guard lock(mutex_);
  return std::exchange(findings_.samples, {});
}

void SolverOutbox::onChange(std::function<void()> tell) {
  const std::lock_guard lock(mutex_);
  tell_ = std::move(tell);
}

}  // namespace deltalux::viewer
