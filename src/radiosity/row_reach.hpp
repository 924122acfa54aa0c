#pragma once
// How far the rays of a row go, by direction: what moves where none of them passes leaves the row as it is, and that is
// told without looking at them. Directions from the middle of the leaf fall into 64 sectors, a grid of 8 x 8 on the
// octahedral map (direction_code.hpp); each keeps the furthest end of a ray, in quarters of octaves. Conservative: rays
// start anywhere on the leaf, so bounds that are tested are grown by it. Rays that something blocks are apart: nothing
// changes them but what that is part of, and what they lead to.
// Cost: a ray some 10 nanoseconds, a test 50; 200 bytes a row.
#include <array>
#include <cstdint>

#include "hierarchy/element.hpp"
#include "paper/object_set.hpp"

namespace deltalux::radiosity {

class RowReach {
 public:
  static constexpr std::size_t kSectors = 64;

  /// A ray of the leaf that ends at `end`.
  void add(const hierarchy::ElementGeometry& leaf, const Vec3f& end);
  void add(const RowReach&);

  /// Whether rays may pass through a box. Never false when one does.
  bool meets(const hierarchy::ElementGeometry& leaf, const Vec3f& lower, const Vec3f& upper) const;

  /// Extends a box by all that rays that pass may pass through.
  void extend(const hierarchy::ElementGeometry& leaf, Vec3f& lower, Vec3f& upper) const;

  bool operator==(const RowReach&) const = default;

  std::array<std::uint8_t, kSectors> furthest{};  // 0: no ray that passes
  paper::ObjectSet objects;                       // of rays that do not: what blocks them, and what they lead to
};

}  // namespace deltalux::radiosity
