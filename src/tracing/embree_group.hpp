#pragma once
// The primitives of one group as an Embree scene: polygons and mesh triangles batched into triangle geometries, curved
// primitives and thin polygons as user geometries in double precision; opaque ones and those that light passes straight
// (panes) apart (they differ in their ray mask). Tables lead from Embree's numbers back to primitives.
//
// Embree finds the triangle; where it is hit follows from the primitive's plane in double precision. So a ray that
// starts on a large polygon does not meet it again, however far from its vertices, and surfaces close together keep
// their order. What is found depends on the ray and the triangle alone, not on the tree.
//
// Cost: building is O(n log n); memory about 220 bytes per triangle.
#include <deltalux/scene.hpp>
#include <vector>

#include "tracing/analytic_surface.hpp"
#include "tracing/embree_handles.hpp"
#include "tracing/embree_queries.hpp"
#include "tracing/embree_records.hpp"

namespace deltalux::tracing {

class EmbreeGroup {
 public:
  /// Throws what throwEmbreeError throws.
  /// `box`: around all of them; `extent`: the largest coordinate of where rays come from.
  EmbreeGroup(RTCDevice, const Scene&, std::vector<PrimitiveId> primitives, const Box& box, float extent);
  EmbreeGroup(const EmbreeGroup&) = delete;
  EmbreeGroup& operator=(const EmbreeGroup&) = delete;

  RTCScene embreeScene() const { return scene_.get(); }
  const std::vector<PrimitiveId>& primitives() const { return primitives_; }
  bool empty() const { return empty_; }

  /// The hit that Embree found in this group's scene.
  Hit hit(const ClosestQuery&, const RTCHit& found) const;
  /// Starts to load what hit() will need.
  void prefetch(const RTCHit& found) const {
    if (found.geomID < 2) __builtin_prefetch(&layers_[found.geomID].triangles.records[found.primID]);
  }

 private:
  /// Opaque primitives, or panes.
  struct Layer {
    TriangleTable triangles;
    std::vector<AnalyticRecord<SphereSurface>> spheres;
    std::vector<AnalyticRecord<CylinderSurface>> cylinders;
    std::vector<AnalyticRecord<ConeSurface>> cones;
    std::vector<AnalyticRecord<RingSurface>> rings;
    std::vector<AnalyticRecord<ThinTriangleSurface>> thinTriangles;
  };
  struct Collection;

  void attachTriangles(RTCDevice, Passage, Collection&);
  template <class Surface>
  void attachAnalytic(RTCDevice, Passage, unsigned kind, std::vector<AnalyticRecord<Surface>>&);
  void attach(RTCGeometry, Passage, unsigned kind);
  /// Triangles without area at two corners, by which the group's box holds all of it with a margin: instances are
  /// entered by whatever arithmetic is fastest, not by the robust one.
  void attachRim(RTCDevice, const Box&, float extent);

  std::vector<PrimitiveId> primitives_;
  std::array<Layer, 2> layers_;
  EmbreeScene scene_;
  bool empty_ = true;
};

}  // namespace deltalux::tracing
