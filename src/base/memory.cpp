#include <deltalux/memory.hpp>

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif

namespace deltalux {

void keepFreedMemory() {
#ifdef M_MMAP_THRESHOLD
  constexpr int kGrowth = 64 << 20;    // of the heap, each time [task]
  constexpr int kAlways = 0x7fffffff;  // more bytes than are ever given back [sentinel]
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, kAlways);
  mallopt(M_TOP_PAD, kGrowth);
#endif
}

}  // namespace deltalux
