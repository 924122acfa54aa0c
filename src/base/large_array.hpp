#pragma once
// Vectors of many megabytes that are made, filled and read once in a while. Where the system has large pages it is
// asked for them: a first touch costs as much for 4 KiB as for 2 MiB, of which a million particles take 200. Values
// that a type does not set by itself are left open by resize(), so that the threads that fill an array touch it first.
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace deltalux {

template <class T>
class LargePages {
 public:
  using value_type = T;

  LargePages() = default;
  template <class U>
  LargePages(const LargePages<U>&) {}

  T* allocate(std::size_t count) {
    if (count > kMost) throw std::bad_alloc();
    const std::size_t bytes = count * sizeof(T);
    if (bytes < kLarge) return std::allocator<T>().allocate(count);
    void* const memory = std::aligned_alloc(kPage, (bytes + kPage - 1) / kPage * kPage);
    if (!memory) throw std::bad_alloc();
#ifdef __linux__
    madvise(memory, bytes, MADV_HUGEPAGE);  // no harm where it is refused
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t count) {
    if (count * sizeof(T) < kLarge)
      std::allocator<T>().deallocate(memory, count);
    else
      std::free(memory);
  }
  template <class U, class... Values>
  void construct(U* at, Values&&... values) {
    if constexpr (sizeof...(Values) == 0)
      ::new (static_cast<void*>(at)) U;
    else
      std::construct_at(at, std::forward<Values>(values)...);
  }

  template <class U>
  bool operator==(const LargePages<U>&) const {
    return true;
  }

 private:
  static constexpr std::size_t kPage = std::size_t(1) << 21;                // [task]
  static constexpr std::size_t kLarge = 2 * kPage;                          // smaller ones gain nothing [task]
  static constexpr std::size_t kMost = (std::size_t(1) << 48) / sizeof(T);  // no system has more [limit]
};

template <class T>
using LargeArray = std::vector<T, LargePages<T>>;

}  // namespace deltalux
