#pragma once
// Three levels of check. CHECK: public preconditions, always. ASSERT: debug builds. VALIDATE: heavy recounts behind a
// build option. checkRare counts what numerics may break now and then, and fails when it is no longer rare.
#include <atomic>
#include <cstdint>
#include <string>

namespace deltalux {

[[noreturn]] void failCheck(const char* expression, const char* file, int line, const std::string& message);

/// Counts occurrences of an event that is rarely allowed; exceeds() compares with the allowed frequency.
class RareEvent {
 public:
  void observe(bool happened) {
    total_.fetch_add(1, std::memory_order_relaxed);
    if (happened) count_.fetch_add(1, std::memory_order_relaxed);
  }
  std::uint64_t count() const { return count_.load(std::memory_order_relaxed); }
  std::uint64_t total() const { return total_.load(std::memory_order_relaxed); }
  bool exceeds(double frequency) const {
    return static_cast<double>(count()) > frequency * static_cast<double>(total()) + 3.0;
  }

 private:
  std::atomic<std::uint64_t> count_{0};
  std::atomic<std::uint64_t> total_{0};
};

}  // namespace deltalux

#define DELTALUX_CHECK(condition, message) \
  do {                                     \
    if (!(condition)) ::deltalux::failCheck(#condition, __FILE__, __LINE__, message); \
  } while (false)

#ifdef NDEBUG
#define DELTALUX_ASSERT(condition) ((void)0)
#else
#define DELTALUX_ASSERT(condition) DELTALUX_CHECK(condition, "")
#endif

#ifdef DELTALUX_VALIDATE
#define DELTALUX_VALIDATED(statement) statement
#else
#define DELTALUX_VALIDATED(statement) ((void)0)
#endif
