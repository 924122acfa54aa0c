#pragma once
// Where a scene has changed: the bounds of what moved, before and after, and what that does to the links.
#include <algorithm>
#include <deltalux/math.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/paged_array.hpp"
#include "hierarchy/link.hpp"
#include "paper/box_groups.hpp"
#include "paper/object_set.hpp"
#include "paper/out_of_sight.hpp"
#include "paper/shaft.hpp"
#include "tracing/ray.hpp"

namespace deltalux::paper {

/// Bounds of all that moved, appeared or went, each where it was and where it is.
class SpaceChange {
 public:
  void add(const Box&);
  /// What another change moved too.
  void add(const SpaceChange&);
  /// What moved: elements of the input level and all below them, and what has none.
  void addMoved(std::span<const hierarchy::ElementId> inputs, const hierarchy::Elements&, const Scene&);
  void addMoved(PrimitiveId, const Scene&);

  bool moved(hierarchy::ElementId e) const { return moved_[e.index()]; }
  /// Of the input level, in the order of ids.
  const std::vector<hierarchy::ElementId>& inputs() const { return inputs_; }
  /// Whether one of the objects that moved, in whole or in part, may be in a set.
  bool meets(const ObjectSet& set) const {
    return std::any_of(objects_.begin(), objects_.end(), [&](const ObjectSet& one) { return set.holds(one); });
  }

  bool empty() const { return parts_.empty(); }
  /// Of all; where there is nothing, inside out.
  const BoxGroups::Part& bounds() const { return parts_.all(); }
  /// Finds out what sees nothing of all this, nor of what has grown, while the rest stands still; until more is added.
  void findHidden(const hierarchy::Elements&, const Scene&, hierarchy::ElementId grown = {});
  /// Whether an element is known to see nothing of what moved, where it was and where it is (out_of_sight.hpp).
  bool hiddenFrom(hierarchy::ElementId e) const { return hidden_ && hidden_->holds(e); }
  /// The flat patch that hides it from an element; none where another reason does.
  hierarchy::ElementId occluder(hierarchy::ElementId e) const {
    return hidden_ ? hidden_->occluder(e) : hierarchy::ElementId();
  }
  /// The largest share that the bounds of one thing take of the hemisphere around a ball, about; 1 for those near by.
  float nearness(const Vec3f& center, float radius) const;
  /// Conservative: never false when what moved is met.
  bool meets(const Shaft&) const;
  bool meets(const tracing::Ray&) const;
  /// Of a box.
  bool meets(const Vec3f& lower, const Vec3f& upper) const;
  /// Of the convex hull of two balls.
  bool meets(const Vec3f& a, float radiusA, const Vec3f& b, float radiusB) const;
  /// A cone of directions that holds all in which it is seen from a ball: its half angle (radians), and `axis`; nothing
  /// when that is no help.
  std::optional<double> seenFrom(const Vec3f& center, float radius, Vec3& axis) const;
  /// Whether all lies in the box.
  bool within(const Box&) const;
  /// Whether there is something, all of it behind a plane (unit normal).
  bool behind(const Vec3f& point, const Vec3f& normal) const;
  /// Of what leaves a ball in directions within an angle of `direction` (unit; the angle in radians).
  bool meetsBeam(const Vec3f& center, float radius, const Vec3f& direction, float angle) const;
  /// The same of what leaves an element's box, for the bounds of all that moves together.
  bool meetsBeam(const hierarchy::ElementGeometry& from, const Vec3f& direction, float angle) const;

 private:
  /// Of balls along a ray, from one radius to another.
  bool meets(const tracing::Ray& axis, float from, float to) const;
  void addInputs(std::span<const hierarchy::ElementId>);
  void addObject(ObjectId top);
  float furthest(const Vec3f& from) const;

  BoxGroups parts_;
  std::vector<hierarchy::ElementId> inputs_;
  PagedArray<char> moved_;
  std::vector<ObjectId> tops_;      // of what moved; ascending
  std::vector<ObjectSet> objects_;  // each of one of them
  std::shared_ptr<const OutOfSight> hidden_;
};

/// What a link has come to, by its index.
enum class LinkChange : std::uint8_t {
  None,
  Touched,  // what moved is in its shaft: rays through it may tell otherwise
  Changed,  // its transfer, its visibility or its place in the tree is another
};

using LinkChanges = PagedArray<LinkChange>;  // links beyond its end are new: Changed

inline LinkChange changeOf(const LinkChanges& changes, hierarchy::LinkId id) {
  return id.index() < changes.size() ? changes[id.index()] : LinkChange::Changed;
}

}  // namespace deltalux::paper
