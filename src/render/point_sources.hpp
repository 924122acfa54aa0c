#pragma once
// Where light comes from at the leaves of a solution: suns and lamps that may shine on a leaf, and cells of the skies
// with the visibility estimates that its lines have found.
#include <mutex>
#include <optional>

#include "direct/aim.hpp"

namespace deltalux {

struct Solution;

}  // namespace deltalux

namespace deltalux::rendering {

class PointSources {
 public:
  /// The solution must outlive this.
  explicit PointSources(const Solution&);

  const direct::PointSampler& light() const { return light_; }
  std::vector<direct::Source> at(hierarchy::ElementId leaf) const;
  /// The same for one point of it, or of a surface without leaves.
  std::vector<direct::Source> at(hierarchy::ElementId leaf, const direct::Receiver&) const;
  /// Irradiance of the leaf [W/m2, gray].
  float lightAt(hierarchy::ElementId leaf) const;
  /// Learnt from points all over a leaf, for about `rays` rays.
  direct::Aim aimAt(hierarchy::ElementId leaf, int rays) const;

 private:
  const direct::SkyVisibility& visibility() const;

  const Solution& s_;
  hierarchy::LeafTable leaves_;
  direct::PointSampler light_;
  mutable std::once_flag counted_;
  mutable std::optional<const direct::SkyVisibility> visibility_;  // counted when first asked for
};

}  // namespace deltalux::rendering
