#pragma once
// What sees nothing of that which moves, where it is and will be: then no light comes or goes between the two, and none
// between it and anything else is kept back or let through. Told by one opaque polygon that every segment between the
// two boxes crosses (strong occlusion), or by the plane of a flat patch that all lies behind. Asked down the tree: what
// hides a cluster hides all in it. Candidates are the polygons along a ray between the middles. In a house, most of
// what is in other rooms is out of sight; walls of meshes, whose triangles are no polygons, are not found.
// Cost: a microsecond for an element whose parent is not hidden, once; four bytes an element.
#include <array>
#include <atomic>
#include <deltalux/shape.hpp>
#include <memory>

#include "hierarchy/element.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux {

class OutOfSight {
 public:
  /// `region`: of all that moves, where it is and will be. All else must stand still, and outlive this.
  OutOfSight(const Elements&, const Scene&, const RayTracer&, const Box& region);

  /// Whether an element is known to see nothing of what moves. From any thread.
  bool holds(ElementId e) const { return state(e) != kSeen; }
  /// The polygon that hides all that moves from it; none where it may be seen, or lies behind.
  PrimitiveId occluder(ElementId) const;

 private:
  static constexpr std::uint32_t kUnknown = 0, kSeen = 1, kBehind = 2, kFirst = 3;  // of occluders, by primitive

  std::uint32_t state(ElementId) const;
  std::uint32_t find(ElementId) const;
  std::uint32_t alongRay(ElementId, std::span<const Vec3> corners) const;
  bool behind(ElementId) const;
  const Polygon* opaque(PrimitiveId) const;

  const Elements& elements_;
  const Scene& scene_;
  const RayTracer& tracer_;
  Box region_;
  std::array<Vec3, 8> corners_;  // of the region
  std::size_t size_;             // elements there were
  std::unique_ptr<std::atomic<std::uint32_t>[]> state_;
};

}  // namespace deltalux
