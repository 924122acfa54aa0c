#pragma once
// A few short light paths from a side of an input-level surface: what irradiance it may have, how far its surroundings
// are, and whether light reaches it at all. An estimate depends on scene and side alone, and tells something of others:
// a side that a ray from a lit point meets is lit. Of surfaces in one place that counts as reached which rays
// meet: light must not count twice.
//
// Lights that are switched off count, faintly: sides that they can reach will be lit by them one day.
// Cost: about 2^17 paths of up to four vertices for all sides together, and in large scenes 24 of every side (8 of a
// mesh's triangle): fewer, and sides that little light reaches are lost.
#include <mutex>
#include <vector>

#include "base/random.hpp"
#include "hierarchy/build.hpp"
#include "hierarchy/input_level.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

struct SideEstimate {
  hierarchy::SurfaceSide side;       // with what is estimated of it
  std::vector<hierarchy::Side> lit;  // sides that rays from its lit points have met, some more than once
  std::vector<hierarchy::Side> met;  // all that its paths have met, where it is lit itself
  std::uint64_t rays = 0;
};

class SideEstimator {
 public:
  /// `sides`: of the scene in all. Scene and tracer must outlive this.
  SideEstimator(const Scene&, const tracing::RayTracer&, std::size_t sides);

  /// Paths from the side's surface: light found at every vertex counts, so that a lit part of a floor does not light
  /// what sees only its dark part.
  SideEstimate estimate(const hierarchy::Side&) const;
  /// What rays from the side meet first, panes aside.
  std::vector<tracing::Hit> firstMet(const hierarchy::Side&, std::size_t rays) const;

 private:
  struct Origin {
    Vec3 position, normal;
  };

  double diagonal() const;
  bool hidden(const hierarchy::Side&, const Origin&) const;
  bool hidden(const hierarchy::Side&, std::size_t points) const;
  Origin pointOnSide(const hierarchy::Side&, Vec2 u) const;
  Rgb wholeReflectance(const hierarchy::Side&) const;
  tracing::Hit look(const Origin&, const Vec3f& w, Rng&, Rgb& through, float& t) const;
  Rgb directAt(const Origin&, Rng&) const;
  Rgb fromLight(const Origin&, const Light&, Rng&) const;
  Rgb fromArea(const Vec3f& x, const Vec3f& n, PrimitiveId, const Rgb& scale, Rng&) const;

  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  std::size_t rays_;  // paths of a side
  mutable std::once_flag measured_;
  mutable double diagonal_ = 0;  // once it is asked for
};

/// The side that a ray has met: of glass, the one that there is.
inline hierarchy::Side sideOf(const Scene& scene, const tracing::Hit& hit) {
  return {hit.primitive, hit.triangle, hit.front || isClear(scene.materialOf(hit.primitive))};
}

/// Whether light reaches a side: glass always has its elements, and what shines through a surface lights both its
/// sides. isLit(Side): by the estimates.
template <class IsLit>
bool isReached(const Scene& scene, const hierarchy::Side& s, const IsLit& isLit) {
  const Material& material = scene.materialOf(s.primitive);
  if (isLit(s) || isClear(material)) return true;
  return !isBlack(diffuseTransmittance(material)) && isLit(hierarchy::Side{s.primitive, s.triangle, !s.front});
}

}  // namespace deltalux::paper
