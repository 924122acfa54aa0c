#pragma once
#include <tbb/enumerable_thread_specific.h>

namespace deltalux {

/// A T for every thread that asks for its local(): memory that is used again. A parallel loop within the use of one may
/// let the thread take up another block, which would find it in use.
template <class T>
using PerThread = tbb::enumerable_thread_specific<T>;

}  // namespace deltalux
