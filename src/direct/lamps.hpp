#pragma once
// The lights of a scene but for skies, as leaves see them: which can shine on a leaf at all, and about how much each
// may bring, without a ray.
#include "direct/lamp_tree.hpp"
#include "scene/light_sampling.hpp"

namespace deltalux::direct {

class Lamps {
 public:
  /// At these scales of lights; those that are black are left out. The scene must outlive this.
  Lamps(const Scene&, const std::vector<Rgb>& scales);

  const scene::LightSampler& sampler() const { return sampler_; }
  std::span<const Lamp> all() const { return all_; }
  /// By index among all: those that are suns.
  std::span<const std::uint32_t> suns() const { return suns_; }
  /// Of all others.
  const LampTree& tree() const { return tree_; }
  /// Whether a narrow beam that may lie on a patch would fall between its samples.
  bool tooWideForBeam(const hierarchy::ElementGeometry&) const;

 private:
  scene::LightSampler sampler_;
  std::vector<Lamp> all_;
  std::vector<std::uint32_t> suns_;
  LampTree tree_, narrow_;
};

}  // namespace deltalux::direct
