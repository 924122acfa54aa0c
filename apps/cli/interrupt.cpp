#include "interrupt.hpp"

#include <atomic>
#include <csignal>
#include <deltalux/error.hpp>

namespace deltalux::cli {

namespace {
// The one thing a signal handler may touch: a lock-free flag.
std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void requestInterrupt(int) { requested.store(true, std::memory_order_relaxed); }
}  // namespace

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = requestInterrupt;
  action.sa_flags = SA_RESETHAND | SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

bool interruptRequested() { return requested.load(std::memory_order_relaxed); }

void throwIfInterrupted() {
  if (interruptRequested()) throw Interrupted();
}

}  // namespace deltalux::cli
