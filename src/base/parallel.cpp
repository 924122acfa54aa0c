#include "base/parallel.hpp"

#include <tbb/info.h>

namespace deltalux {

std::size_t ThreadLimit::defaultThreads() { return static_cast<std::size_t>(tbb::info::default_concurrency()); }

}  // namespace deltalux
