#pragma once
// Which lights reach a leaf patch, and how much each is expected to give: read off the links that bring it direct
// light, its ancestors' included. Shadow rays are then aimed where light comes from: at the cells of the sky that a
// window shows, at the three lamps of a hundred that are in the room. Links that are proven to carry nothing are left
// out; links whose sample rays were all blocked keep a small share, so that nothing a finer look could find is lost.
// Cost: one pass over the links to build; a walk up the hierarchy per leaf.
#include <span>

#include "hierarchy/link.hpp"

namespace deltalux {

struct ExpectedSender {
  ElementId sender;  // emitter patch, cluster of emitters, point or distant cell
  float share = 0;   // expected irradiance, gray [W/m2]; > 0
};

class DirectSenders {
 public:
  /// All must outlive this.
  DirectSenders(const Elements&, const Links&, const Scene&);

  /// Appends the senders of a leaf patch.
  void collect(ElementId leaf, std::vector<ExpectedSender>& out) const;
  /// Appends all lights with what they would give at a free point if nothing stood between (`normal` unit).
  void collectAll(const Vec3f& x, const Vec3f& normal, std::vector<ExpectedSender>& out) const;

 private:
  struct Arriving {
    ElementId sender;
    float share;  // at patch receivers; at clusters before the cosine
  };
  float strength(ElementId receiver, ElementId sender) const;
  void collectAll(ElementId e, const Vec3f& x, const Vec3f& normal, std::vector<ExpectedSender>& out) const;

  const Elements& elements_;
  const Scene& scene_;
  std::vector<std::uint32_t> begin_;  // per element, one more
  std::vector<Arriving> arriving_;
};

}  // namespace deltalux
