#include "long_call.hpp"

#include <tbb/global_control.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace deltalux::python {

namespace py = pybind11;

namespace {

constexpr std::chrono::milliseconds kPause{50};  // between two looks at signals and progress

/// Keeps the last report until the calling thread asks for it.
class LastReport : public Progress {
 public:
  void report(std::string_view phase, double fraction) override {
    const std::lock_guard lock(mutex_);
    last_.emplace(phase, std::clamp(fraction, 0.0, 1.0));
  }
  bool stopRequested() const override { return stop_.load(std::memory_order_relaxed); }

  void stop() { stop_.store(true, std::memory_order_relaxed); }
  std::optional<std::pair<std::string, double>> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(last_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::optional<std::pair<std::string, double>> last_;
  std::atomic<bool> stop_{false};
};

/// A thread that does the work, to be waited for.
class Worker {
 public:
  Worker(std::size_t threads, const std::function<void(Progress&)>& work, Progress& progress)
      : thread_([this, threads, &work, &progress] {
          try {
            std::optional<tbb::global_control> limit;
            if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, threads);
            work(progress);
          } catch (...) {
            failure_ = std::current_exception();
          }
          const std::lock_guard lock(mutex_);
          ended_ = true;
          end_.notify_one();
        }) {}

  /// Whether the work has ended, after waiting for that a moment.
  bool ended() {
    std::unique_lock lock(mutex_);
    return end_.wait_for(lock, kPause, [this] { return ended_; });
  }
  /// What the work has thrown. Once it has ended.
  std::exception_ptr failure() {
    thread_.join();
    return failure_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable end_;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // last: it uses the others
};

}  // namespace

void runLong(const py::object& progress, std::size_t threads, const std::function<void(Progress&)>& work) {
  LastReport reports;
  Worker worker(threads, work, reports);
  std::exception_ptr raised;
  for (bool ended = false; !ended;) {
    {
      const py::gil_scoped_release unlocked;
      ended = worker.ended();
    }
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (const auto last = reports.take(); last && !progress.is_none()) progress(last->first, last->second);
    } catch (const py::error_already_set&) {
      raised = std::current_exception();
      reports.stop();
    }
  }
  const std::exception_ptr failure = worker.failure();
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

}  // namespace deltalux::python
