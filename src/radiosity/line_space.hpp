#pragma once
// Line-space traversal [GD01 5; DS97]: which links what moves can touch. Descends the link tree from its roots; a link
// whose shaft misses the bounds of what moved is pruned with all below it. No shaft is stored: they are rebuilt from
// the two boxes on the way down. Run before the elements move, with the old bounds, and after, with the new ones, on
// the same marks.
//
// A touched link is looked at anew only when that can tell another story: an end of it moved, a ray that sampled its
// visibility meets the bounds, it was proven clear, or proven blocked by what now goes.
// Cost: some 0.1 microseconds a link visited; links visited are those of shafts through the bounds, and their siblings.
#include "radiosity/space_change.hpp"

namespace deltalux {

struct LinkMarks {
  LinkChanges changes;          // by link: Touched so far
  std::vector<LinkId> touched;  // active links
  std::vector<LinkId> anew;     // to be judged anew
  std::vector<char> isAnew;     // by link
  std::vector<LinkId> lit;      // from lights of which some moved: Changed in any case
  std::uint64_t visited = 0;
};

class LineSpace {
 public:
  /// `change` says which elements moved.
  LineSpace(const Links&, const Elements&, const Scene&, const SpaceChange& change);

  /// Adds to `marks` what these bounds touch. `arriving`: what moved comes to them, rather than leaving them.
  void visit(const SpaceChange& bounds, bool arriving, LinkMarks& marks) const;

 private:
  struct Finding;
  Finding examine(LinkId, const SpaceChange&, bool arriving) const;
  bool moves(const Link&) const;
  bool heldBack(const Link&) const;

  const Links& links_;
  const Elements& elements_;
  const Scene& scene_;
  const SpaceChange& change_;
  std::vector<char> holds_;          // by element: a cluster with some of what moved
  std::vector<ElementId> blockers_;  // input-level patches of what moved
};

}  // namespace deltalux
