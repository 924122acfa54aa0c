#pragma once
// Where a scene has changed: the bounds of what moved, before and after, and what that does to the links.
#include <deltalux/math.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/paged_array.hpp"
#include "hierarchy/link.hpp"
#include "paper/box_groups.hpp"
#include "paper/out_of_sight.hpp"
#include "paper/shaft.hpp"
#include "tracing/ray.hpp"

namespace deltalux::paper {

/// Bounds of all that moved, appeared or went, each where it was and where it is.
class SpaceChange {
 public:
  void add(const Box&);
  /// What moved: elements of the input level and all below them.
  void addMoved(std::span<const hierarchy::ElementId> inputs, const hierarchy::Elements&);

  bool moved(hierarchy::ElementId e) const { return moved_[e.index()]; }
  /// Of the input level, in the order of ids.
  const std::vector<hierarchy::ElementId>& inputs() const { return inputs_; }

  bool empty() const { return parts_.empty(); }
  /// Finds out what sees nothing of all this while the rest stands still; until more is added.
  void findHidden(const hierarchy::Elements&, const Scene&);
  /// Whether an element is known to see nothing of what moved, where it was and where it is (out_of_sight.hpp).
  bool hiddenFrom(hierarchy::ElementId e) const { return hidden_ && hidden_->holds(e); }
  /// Conservative: never false when what moved is met.
  bool meets(const Shaft&) const;
  bool meets(const tracing::Ray&) const;
  /// Of the convex hull of two balls.
  bool meets(const Vec3f& a, float radiusA, const Vec3f& b, float radiusB) const;
  /// A cone of directions that holds all in which it is seen from a ball: its half angle (radians), and `axis`; nothing
  /// when that is no help.
  std::optional<double> seenFrom(const Vec3f& center, float radius, Vec3& axis) const;
  /// Of what leaves an element's box in directions within an angle of `direction` (unit; the angle in radians), for the
  /// bounds of all that moves together.
  bool meetsBeam(const hierarchy::ElementGeometry& from, const Vec3f& direction, float angle) const;

 private:
  float furthest(const Vec3f& from) const;

  BoxGroups parts_;
  std::vector<hierarchy::ElementId> inputs_;
  PagedArray<char> moved_;
  std::shared_ptr<const OutOfSight> hidden_;
};

}  // namespace deltalux::paper
