#pragma once
// The paths that come near where something moves, so that a motion need not ask all of them: what the octree around the
// moving object is in [GD01 4.1], as one region and a bit a path. While things move within the region, only paths with
// a segment through it, and those that were never begun, can be touched.
// Cost: to build, a look at every segment; memory an eighth of a byte a path.
#include "particles/particles.hpp"
#include "particles/segment_box.hpp"

namespace deltalux::particles {

class PathWatch {
 public:
  /// `margin`: by which things may be off their boxes.
  PathWatch(const Particles&, const Box& region, double margin);

  bool covers(const Box& box) const {
    return box.empty() || (region_.contains(box.lower) && region_.contains(box.upper));
  }
  /// These paths go elsewhere now.
  void renew(const Particles&, std::span<const std::uint32_t> paths);

  static constexpr std::size_t kPathsOfWord = 64;  // [layout]
  /// Bits of kPathsOfWord paths each.
  const std::vector<std::uint64_t>& words() const { return words_; }
  std::size_t memoryBytes() const { return words_.capacity() * sizeof words_[0]; }

 private:
  bool comesNear(const Particles&, std::size_t path) const;

  Box region_;
  SegmentBox box_;
  std::vector<std::uint64_t> words_;
};

}  // namespace deltalux::particles
