#pragma once
// The lights of a scene but for skies, as leaves see them: which can shine on a leaf at all, and about how much each
// may bring, without a ray.
#include "hierarchy/element.hpp"
#include "scene/light_sampling.hpp"

namespace deltalux::direct {

struct Lamp {
  LightId id;
  bool sun = false;
  Vec3f lower{0.0f}, upper{0.0f};  // box; of suns nothing
  Vec3 axis{0, 0, 1};              // of the sun's disc, of a spot's cone, or the normal of a flat lamp
  double halfAngle = kPi;          // that the light stays within about the axis, or the sun's disc [radians]
  bool flat = false;               // one-sided and plane: nothing behind it is lit
  double beam = kPi;               // half angle of where it is brightest, when narrow: it may fall between samples
  double most = 0;                 // greatest intensity over directions, about [W/sr, gray]; of suns irradiance [W/m2]
};

class Lamps {
 public:
  /// The scene must outlive this.
  explicit Lamps(const Scene&);

  const scene::LightSampler& sampler() const { return sampler_; }
  std::span<const Lamp> all() const { return all_; }
  /// Irradiance that a lamp may bring to a patch, about, unshadowed [W/m2, gray]; 0 where it provably cannot: it lies
  /// behind the patch, the patch behind it, or outside its cone.
  double potential(const Lamp&, const hierarchy::ElementGeometry&) const;
  /// Width of a narrow beam at a patch that may lie in it [scene units]; infinite for all others.
  double beamWidth(const Lamp&, const hierarchy::ElementGeometry&) const;

 private:
  scene::LightSampler sampler_;
  std::vector<Lamp> all_;
};

}  // namespace deltalux::direct
