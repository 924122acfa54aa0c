#pragma once
// Arrays that passes over rows of slots read a vector at a time: they begin where a line of the cache begins.
#include <cstddef>
#include <new>
#include <vector>

namespace deltalux::caustics {

template <class T>
struct LineAllocator {
  using value_type = T;
  static constexpr std::align_val_t kLine{64};  // [layout]

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, std::size_t) { ::operator delete(p, kLine); }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};

/// Values by slot (cell_raster.hpp).
using Slots = std::vector<float, LineAllocator<float>>;

}  // namespace deltalux::caustics
