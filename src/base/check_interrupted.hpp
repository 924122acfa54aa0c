#pragma once
#include <deltalux/error.hpp>
#include <deltalux/progress.hpp>

namespace deltalux {

/// Throws Interrupted when asked to stop. `progress` may be null.
inline void checkInterrupted(const Progress* progress) {
  if (progress && progress->stopRequested()) throw Interrupted();
}

}  // namespace deltalux
