#pragma once
// The one virtual seam: rays against the primitives of a scene. Two implementations: Embree, and brute force as its
// test twin. Rays know primitives, not elements.
//
// Static geometry and each group of movable primitives are separate acceleration structures under one top level, so
// that moving a cup never rebuilds the house. A moved group is rebuilt from its new world coordinates rather than
// instanced with a matrix: the same geometry then gives bitwise the same hits, however it got there.
#include <cstdint>
#include <deltalux/scene.hpp>
#include <memory>
#include <span>

#include "base/per_thread.hpp"
#include "tracing/ray.hpp"

namespace deltalux::tracing {

using GroupId = Id<struct GroupTag>;  // group 0 is the static rest of the scene

/// What of light passes a segment, and a surface that ends it where nothing does (any one of those there are).
struct Passing {
  Rgb share{1.0f};
  PrimitiveId blocker;
  float t = 0;  // where the blocker is met
};

class RayTracer {
 public:
  virtual ~RayTracer() = default;

  /// First surface with tNear <= t <= tFar; an invalid primitive when there is none. What light passes straight through
  /// counts as a surface. Of surfaces that coincide, the one of the lowest id.
  virtual Hit closestHit(const Ray&) const = 0;
  /// Whether an opaque surface (one that nothing passes straight) lies on the segment.
  virtual bool occluded(const Ray&) const = 0;
  /// Fraction of light that passes the segment straight on: product over panes and uncovered parts crossed, 0
  /// behind opaque ones.
  virtual Rgb transmittance(const Ray&) const = 0;
  /// The same, with a blocker.
  virtual Passing passing(const Ray&) const = 0;

  /// Batches of incoherent rays; results at the same index. Sizes must agree.
  virtual void closestHits(std::span<const Ray>, std::span<Hit>) const;
  virtual void transmittances(std::span<const Ray>, std::span<Rgb>) const;
  virtual void passings(std::span<const Ray>, std::span<Passing>) const;

  /// Puts `primitives` into a group of their own (out of the group they are in, which is rebuilt). Like rebuild(), not
  /// while other threads trace.
  virtual GroupId separate(std::span<const PrimitiveId> primitives) = 0;
  /// Takes the present shapes of the scene's primitives of `group` in, and whether they are panes; the rest is
  /// untouched. Primitives added to the scene since belong to group 0.
  virtual void rebuild(GroupId group) = 0;
  /// Puts everything back into group 0, and takes it in; there are no other groups then.
  virtual void rejoin() = 0;
  /// transmittance() against the primitives of one group only.
  virtual Rgb transmittance(const Ray&, GroupId group) const = 0;

  /// Queries of rays answered so far, of every kind. Exact while no other thread traces.
  std::uint64_t traced() const;

 protected:
  /// For every query. Cost: some nanoseconds.
  void count(std::size_t rays) const { traced_.local() += rays; }

 private:
  mutable PerThread<std::uint64_t> traced_{std::uint64_t{0}};
};

/// The scene must outlive the tracer. Primitives without an extent (removed objects) are left out.
std::unique_ptr<RayTracer> makeEmbreeTracer(const Scene&);
std::unique_ptr<RayTracer> makeBruteForceTracer(const Scene&);

}  // namespace deltalux::tracing
