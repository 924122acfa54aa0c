#pragma once
// Irradiance of the leaf patches as reconstruction wants it. A link gives all of its receiver one value, its mean;
// where the receiver has been refined on, for other links' sake, that value makes blocks in the picture. Here every
// link is evaluated once more, at each leaf below its receiver and with the leaf's own normal (the local pass of
// [LTG93], with links in place of a mesh of discontinuities); links that hardly vary over their receiver keep their
// mean. Visibility stays the link's. Cost: links of a leaf and its ancestors, summed over leaves; one kernel for those
// that vary.
#include "hierarchy/link.hpp"
#include "render/leaf_irradiance.hpp"

namespace deltalux {

struct Solution;

class LeafGather {
 public:
  /// The solution must outlive this.
  explicit LeafGather(const Solution&);

  /// Indirect light of a leaf patch, particles left out [W/m2].
  Rgb indirectAt(ElementId leaf) const;
  /// The same by the leaf's links at a point of it, with the unit normal there.
  Rgb indirectAt(ElementId leaf, const Vec3f& p, const Vec3f& normal) const;

 private:
  bool carries(const Link&) const;
  template <class KernelAt>
  Rgb sum(ElementId leaf, float negligible, const KernelAt&) const;

  const Solution& s_;
  const Elements& e_;
  std::vector<std::uint32_t> begin_;  // per receiver, one more
  std::vector<LinkId> links_;
};

/// By element; those of receiving leaves are filled. Direct light is the mesh's.
std::vector<LeafIrradiance> gatherAtLeaves(const Solution&);

}  // namespace deltalux
