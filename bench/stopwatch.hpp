#pragma once
#include <chrono>

#include "processor_time.hpp"

namespace deltalux::bench {

/// Wall and processor time since it was made.
class Stopwatch {
 public:
  double wall() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  double processor() const { return processorSeconds() - cpu_; }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double cpu_ = processorSeconds();
};

}  // namespace deltalux::bench
