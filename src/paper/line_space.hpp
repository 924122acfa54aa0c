#pragma once
// Line-space traversal [GD01 5; DS97]: which links what moves can touch. Descends the link tree from its roots; a link
// whose shaft misses the bounds of what moved is pruned with all below it. No shaft is stored: they are rebuilt from
// the two boxes on the way down. Run before the elements move: the ends of all links but those that are marked anyway
// stay where they are, so each shaft is built once and tested against the old bounds and the new.
//
// What sees nothing of what moves prunes links likewise: nothing changes between it and anything else that stays.
//
// A touched link is looked at anew only when that can tell another story: an end of it moved, a ray that sampled its
// visibility meets the bounds, it was proven clear, or proven blocked by what now goes.
// Cost: some 0.1 microseconds a link visited; links visited are those of shafts through the bounds, and their siblings.
#include <span>

#include "paper/space_change.hpp"

namespace deltalux::paper {

/// A link between whose ends something has changed.
struct DisturbedLink {
  hierarchy::LinkId link;
  std::uint32_t rays = 0;  // which of those that sampled it may fare otherwise, by bits
};

/// Links that are to be evaluated again.
struct LinkMarks {
  std::vector<DisturbedLink> between;
  std::vector<hierarchy::LinkId> moved;    // an end of theirs moved, or holds what moved
  std::vector<hierarchy::LinkId> made;     // root links that were made since
  std::vector<hierarchy::LinkId> shifted;  // not evaluated again: an end holds what became inactive, and moves
  std::uint64_t visited = 0;
};

/// Adds what another traversal has found to `marks`.
void add(const LinkMarks&, LinkMarks& marks);

class LineSpace {
 public:
  /// `change` says which elements move, `before` and `after` the bounds of those where they are and will be.
  LineSpace(const hierarchy::Links&, const hierarchy::Elements&, const Scene&, const SpaceChange& change,
            const SpaceChange& before, const SpaceChange& after);

  LinkMarks visit() const;

 private:
  struct Finding;
  struct Block;
  Finding examine(hierarchy::LinkId) const;
  void examine(std::span<const hierarchy::LinkId>, Block& found) const;
  bool heldBack(const hierarchy::Link&) const;
  /// It moves, or some of it.
  bool involved(hierarchy::ElementId e) const { return change_.moved(e) || above_[e.index()]; }

  const hierarchy::Links& links_;
  const hierarchy::Elements& elements_;
  const Scene& scene_;
  const SpaceChange &change_, &before_, &after_;
  PagedArray<char> above_;                      // by element: a cluster with some of what moves
  std::vector<hierarchy::ElementId> blockers_;  // input-level patches of what moved
};

}  // namespace deltalux::paper
