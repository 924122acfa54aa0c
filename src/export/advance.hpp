#pragma once
#include "base/check_interrupted.hpp"

namespace deltalux::exporting {

/// Reports, and throws Interrupted when asked to stop.
inline void advance(Progress* progress, const char* phase, double fraction) {
  if (!progress) return;
  progress->report(phase, fraction);
  checkInterrupted(progress);
}

}  // namespace deltalux::exporting
