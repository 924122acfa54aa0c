#pragma once
// How much of a leaf patch light can reach: the rest lies under what stands on it. Irradiance of a leaf is that of its
// exposed part, so what peeps out beside a table's foot is as bright as it should be, and a leaf sends on all that it
// reflects instead of losing a share of it into what covers it.
//
// A point counts as covered when a ray from it meets a side that no light path reaches (it has no element): close by,
// so that of a point at the rim of what stands there the share counts that it sends into the dark; or farther away,
// when all of a few rays do. Cost: 20 rays a leaf, most of them short; 64 points and a few more rays where something
// stands on it, up to 1024 in small scenes.
#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::radiosity {

class Exposure {
 public:
  /// All must outlive this.
  Exposure(const Scene&, const hierarchy::Elements&, const tracing::RayTracer&);

  /// Share of the leaf's area, above 0; 1 when nothing of it is seen exposed.
  float of(hierarchy::ElementId leaf) const;

 private:
  bool stoodUpon(hierarchy::ElementId leaf) const;
  bool covered(const Vec3f& p, const Vec3f& normal, float near, std::uint64_t key) const;

  const Scene& scene_;
  const hierarchy::Elements& elements_;
  const tracing::RayTracer& tracer_;
  int points_;
};

}  // namespace deltalux::radiosity
