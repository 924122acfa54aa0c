#pragma once
#include <deltalux/error.hpp>
#include <deltalux/progress.hpp>

namespace deltalux::exporting {

/// Reports, and throws Interrupted when asked to stop.
inline void advance(Progress* progress, const char* phase, double fraction) {
  if (!progress) return;
  progress->report(phase, fraction);
  if (progress->stopRequested()) throw Interrupted();
}

}  // namespace deltalux::exporting
