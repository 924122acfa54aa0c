#pragma once
// Gather over links: every element collects E += K V B over the active links at it, direct light (from the light tree
// and distant senders) and indirect light apart [GD01 2.1]. Links are sorted by receiver once per refinement, so that
// each receiver is summed by one thread in one order: the result does not depend on the thread count.
#include "hierarchy/link.hpp"

namespace deltalux::paper {

/// Whether a link brings its receiver light.
inline bool bringsLight(const hierarchy::Link& l) {
  return l.state == hierarchy::LinkState::Active && l.K > 0 && !isBlack(l.V);
}

/// Active links by receiver, reduced to what gathering needs.
class GatherPlan {
 public:
  GatherPlan(const hierarchy::Links&, const hierarchy::Elements&);

  /// Fills directGathered of every element (and of clusters their directional fields).
  void gatherDirect(hierarchy::Elements&) const;
  /// Fills indirectGathered from the present B and intensities.
  void gatherIndirect(hierarchy::Elements&) const;

 private:
  struct Transfer {
    hierarchy::ElementId sender;
    Rgb T;  // K V
  };
  void gather(hierarchy::Elements&, bool direct) const;

  std::vector<hierarchy::ElementId> receivers_;  // those with links, ascending
  std::vector<std::uint32_t> begin_, split_;  // per receiver: first transfer, first indirect one; begin_ has one more
  std::vector<Transfer> transfers_;
};

}  // namespace deltalux::paper
