#pragma once
// How much of a leaf patch light can reach: the rest lies under what stands on it. Irradiance of a leaf is that of its
// exposed part, so what peeps out beside a table's foot is as bright as it should be, and a leaf sends on all that it
// reflects instead of losing a share of it into what covers it.
//
// A point counts as covered when all of a few rays from it meet sides that no light path reaches (they have no
// element). Cost: 16 rays a leaf; 64 and a few more where some of them are covered.
#include "hierarchy/side_locator.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

class Exposure {
 public:
  /// All must outlive this.
  Exposure(const Scene&, const Elements&, const RayTracer&);

  /// Share of the leaf's area, above 0; 1 when nothing of it is seen exposed.
  float of(ElementId leaf) const;

 private:
  bool covered(const Vec3f& p, const Vec3f& normal, std::uint64_t key) const;

  const Scene& scene_;
  const Elements& elements_;
  const RayTracer& tracer_;
  SideLocator locator_;
};

}  // namespace deltalux
