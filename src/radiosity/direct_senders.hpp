#pragma once
// Which lights may reach a leaf patch: read off the links that bring it direct light, its ancestors' included. Shadow
// rays are then aimed where light comes from: at the cells of the sky that a window shows, at the three lamps of a
// hundred that are in the room. Links that are proven to carry nothing are left out. Parts of a curved light are taken
// for the whole: it is sampled by the angle that it fills. Cost: a walk up the hierarchy per leaf.
#include <span>
#include <vector>

#include "base/paged_array.hpp"
#include "hierarchy/link.hpp"

namespace deltalux::radiosity {

/// Of an emitter, gray: what it sends at present.
float shownStrength(const hierarchy::Elements&, hierarchy::ElementId);
/// The same, and no less than what it is credited with, so that rows hold lights that are off or dim for now.
float creditedStrength(const hierarchy::Elements&, hierarchy::ElementId);

constexpr float kBrighter = 8.0f;  // times as bright as it was, a light may become before rows are wrong for it
/// Credits lights with what they send now over kBrighter, or more where they were; links and rows are about to be made.
void creditLights(hierarchy::Elements&);

struct PossibleSender {
  hierarchy::LinkId link;       // that covers it, perhaps split since; invalid for free points
  hierarchy::ElementId sender;  // emitter patch, cluster of emitters, point or distant cell
  float potential = 0;          // irradiance if nothing stands between, gray [W/m2]; > 0
  float open = 0;               // share of the link's rays that passed; 1 when nothing can stand between
  std::uint8_t rays = 0;        // that the link sampled; 0: none were needed, or none were taken
};

class DirectSenders {
 public:
  using Strength = float (*)(const hierarchy::Elements&, hierarchy::ElementId);
  /// All must outlive this.
  DirectSenders(const hierarchy::Elements&, const hierarchy::Links&, const Scene&, Strength = shownStrength);

  /// The senders of a leaf patch.
  std::vector<PossibleSender> at(hierarchy::ElementId leaf) const;
  /// Those of some links alone, of such as arrive at the leaf or above it.
  std::vector<PossibleSender> over(std::span<const hierarchy::LinkId>, hierarchy::ElementId leaf) const;
  /// All lights as a free point sees them (`normal` unit).
  std::vector<PossibleSender> at(const Vec3f& x, const Vec3f& normal) const;

 private:
  float strength(hierarchy::ElementId receiver, hierarchy::ElementId sender) const;
  void addLink(hierarchy::LinkId, hierarchy::ElementId leaf, std::vector<PossibleSender>& out) const;
  std::vector<PossibleSender> joined(const std::vector<PossibleSender>&) const;
  void addLights(hierarchy::ElementId light, hierarchy::ElementId leaf, const PossibleSender& by,
                 std::vector<PossibleSender>& out) const;
  void collectAll(hierarchy::ElementId e, const Vec3f& x, const Vec3f& normal, std::vector<PossibleSender>& out) const;

  const hierarchy::Elements& elements_;
  const hierarchy::Links& links_;
  const Scene& scene_;
  Strength strengthOf_;
  PagedArray<std::uint32_t> lightCount_;  // per element of the light tree: lights below it, itself included
};

}  // namespace deltalux::radiosity
