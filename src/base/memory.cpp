#include <algorithm>
#include <deltalux/memory.hpp>
#include <fstream>

#include "base/freed_memory.hpp"

#if __has_include(<malloc.h>)
#include <malloc.h>
#endif
#if __has_include(<unistd.h>)
#include <unistd.h>
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

void FreedMemory::giveBack() {
#ifdef __GLIBC__
  const std::uint64_t resident = residentBytes();
  if (usual_ == 0) usual_ = resident;
  if (resident <= usual_ + usual_ / 8) return;
  malloc_trim(0);
  usual_ = std::max(usual_, residentBytes());  // there is more now that is in use
#endif
}

std::uint64_t residentBytes() {
#ifdef _SC_PAGESIZE
  std::ifstream file("/proc/self/statm");  // Linux
  std::uint64_t pages = 0, resident = 0;
  if (file >> pages >> resident) return resident * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
#endif
  return 0;
}

}  // namespace deltalux
