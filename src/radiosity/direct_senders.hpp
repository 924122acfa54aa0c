#pragma once
// Which lights may reach a leaf patch: read off the links that bring it direct light, its ancestors' included. Shadow
// rays are then aimed where light comes from: at the cells of the sky that a window shows, at the three lamps of a
// hundred that are in the room. Links that are proven to carry nothing are left out. Cost: a walk up the hierarchy per
// leaf.
#include <vector>

#include "hierarchy/link.hpp"

namespace deltalux {

struct PossibleSender {
  LinkId link;            // that covers it; invalid for free points
  ElementId sender;       // emitter patch, cluster of emitters, point or distant cell
  float potential = 0;    // irradiance if nothing stands between, gray [W/m2]; > 0
  float open = 0;         // share of the link's rays that passed; 1 when nothing can stand between
  std::uint8_t rays = 0;  // that the link sampled; 0: none were needed, or none were taken
};

class DirectSenders {
 public:
  /// All must outlive this.
  DirectSenders(const Elements&, const Links&, const Scene&);

  /// The senders of a leaf patch.
  std::vector<PossibleSender> at(ElementId leaf) const;
  /// All lights as a free point sees them (`normal` unit).
  std::vector<PossibleSender> at(const Vec3f& x, const Vec3f& normal) const;

 private:
  float strength(ElementId receiver, ElementId sender) const;
  void addLights(ElementId light, ElementId leaf, const PossibleSender& by, std::vector<PossibleSender>& out) const;
  void collectAll(ElementId e, const Vec3f& x, const Vec3f& normal, std::vector<PossibleSender>& out) const;

  const Elements& elements_;
  const Links& links_;
  const Scene& scene_;
  std::vector<std::uint32_t> lightCount_;  // per element of the light tree: lights below it, itself included
};

}  // namespace deltalux
