#pragma once
#include <sys/resource.h>

namespace deltalux::bench {

/// Processor time of this process so far, its own and the system's for it. [s]
inline double processorSeconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace deltalux::bench
