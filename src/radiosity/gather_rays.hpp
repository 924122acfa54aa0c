#pragma once
// How many rays gather a leaf's indirect light. Most leaves are small, there for the sake of a shadow's edge; a
// twentieth of them hold most of the area and of the light. An error of a large leaf is seen over all of it, one of a
// leaf that much light falls on is passed on to all others: each has rays as the root of the greater of both, by powers
// of two, so that near twins of a scene take the same. The rays of all grow by a tenth.
#include <span>

#include "radiosity/leaf_row.hpp"

namespace deltalux::radiosity {

/// What leaves hold in the mean.
struct MeanLeaf {
  double area = 0;   // exposed [unit^2]
  double light = 0;  // that falls on it from other leaves, gray [W in unit^2 as area]
};

MeanLeaf meanOf(std::span<const hierarchy::ElementId> leaves, const hierarchy::Elements&);

class GatherRays {
 public:
  /// `leaves`: how many there are.
  GatherRays(const LeafTransferSettings&, std::size_t leaves, const MeanLeaf&);

  int of(hierarchy::ElementId leaf, const hierarchy::Elements&) const;

 private:
  int fewest_, most_;
  MeanLeaf mean_;
};

}  // namespace deltalux::radiosity
