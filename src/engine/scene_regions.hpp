#pragma once
// A scene's patches in 64 regions of about as many leaves each: median splits of their centres along the longest axis.
// Elements are named by the region that they were in when they were first seen.
#include <array>
#include <cstdint>

#include "hierarchy/element.hpp"

namespace deltalux::engine {

class SceneRegions {
 public:
  static constexpr int kCount = 64;
  using Set = std::uint64_t;

  explicit SceneRegions(const hierarchy::Elements&);

  /// Names elements that came since.
  void follow(const hierarchy::Elements&);

  int of(hierarchy::ElementId e) const { return of_[e.index()]; }
  Set setOf(hierarchy::ElementId e) const { return Set(1) << of_[e.index()]; }

 private:
  struct Split {
    int axis = 0;
    float at = 0;
  };
  void split(std::size_t node, std::span<Vec3f> centers);

  std::array<Split, kCount> splits_;  // a heap from 1
  std::vector<std::uint8_t> of_;      // by element
};

}  // namespace deltalux::engine
