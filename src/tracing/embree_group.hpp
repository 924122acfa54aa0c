#pragma once
// The primitives of one group as an Embree scene: polygons and mesh triangles batched into triangle geometries, curved
// primitives and thin polygons as user geometries in double precision; opaque ones and panes of thin glass apart (they
// differ in their ray mask). Tables lead from Embree's numbers back to primitives.
//
// Embree finds the triangle; where it is hit follows from the primitive's plane in double precision. So a ray that
// starts on a large polygon does not meet it again, however far from its vertices, and surfaces close together keep
// their order.
//
// Cost: building is O(n log n); memory about 200 bytes per triangle.
#include <deltalux/scene.hpp>
#include <vector>

#include "tracing/analytic_surface.hpp"
#include "tracing/embree_handles.hpp"
#include "tracing/ray.hpp"

namespace deltalux {

enum class Passage : unsigned { Opaque = 1, Pane = 2 };  // ray masks

/// One of Embree's triangles, with the plane of its primitive: dot(normal, p) = offset.
struct TriangleRecord {
  TriangleRecord(PrimitiveId, std::uint32_t triangle, const Vec3& normal, const Vec3& point);
  /// Where the ray meets the plane, given where Embree saw it meet the triangle.
  double meet(const Vec3& origin, const Vec3& direction, float seen) const;

  Vec3 normal;  // unit
  double offset;
  PrimitiveId primitive;
  std::uint32_t triangle;  // in the mesh; 0 in polygons
};

/// One of Embree's user primitives, with bounds that hold in single precision.
template <class Surface>
struct AnalyticRecord {
  AnalyticRecord(const Surface&, PrimitiveId, const Box& bounds);

  Surface surface;
  PrimitiveId primitive;
  Vec3f lower, upper;
};

/// What a closest-hit query knows besides its ray: the nearest hit so far. Where surfaces coincide (in single
/// precision) the primitive of the lowest id is hit, in whatever order Embree meets them. Triangles count by their
/// exact t, which is worked out only where it could matter: near another hit or an end of the segment.
class ClosestQuery : public RTCIntersectContext {
 public:
  explicit ClosestQuery(const Ray&);

  /// Whether the hit lies on the segment and becomes the nearest. `id` is in a table ordered by triangle.
  bool take(double t, const PrimitiveId* id);
  bool take(const TriangleRecord&, float seen);
  /// How far Embree should look on: past the nearest hit by what its t may be off.
  float reach() const;

  const Ray& ray() const { return *ray_; }
  /// The nearest hit, once Embree is done.
  double exact() const { return unsettled_ ? settled() : nearest_; }
  PrimitiveId primitive() const { return *holder_; }

 private:
  double settled() const;
  float doubt(float t) const { return kDoubt * (originSize_ + t); }

  static constexpr float kDoubt = 2e-4f;  // of the coordinates: single precision's, along rather grazing rays
  const Ray* ray_;
  float originSize_;
  double nearest_ = std::numeric_limits<double>::infinity();
  const PrimitiveId* holder_ = nullptr;
  const TriangleRecord* unsettled_ = nullptr;  // whose t is as Embree saw it
};

/// What an occlusion query knows besides its ray: panes on the way multiply `passed` instead of ending the query.
struct PassageQuery : RTCIntersectContext {
  PassageQuery(const Scene& s, const Ray& ray) : scene(s), segment(ray) { rtcInitIntersectContext(this); }

  /// Counts the pane once, though a ray may meet it in two triangles that share an edge. False when no light is left.
  bool cross(PrimitiveId pane, float t, double cosIncidence);

  const Scene& scene;
  const Ray& segment;
  Rgb passed{1.0f};

 private:
  struct Crossed {
    PrimitiveId pane;
    float t;
  };
  bool isRepeat(const Crossed&) const;

  static constexpr std::size_t kFew = 8;
  std::array<Crossed, kFew> few_;
  std::vector<Crossed> more_;  // beyond the few
  std::size_t count_ = 0;
};

class EmbreeGroup {
 public:
  /// Throws what throwEmbreeError throws.
  EmbreeGroup(RTCDevice, const Scene&, std::vector<PrimitiveId> primitives);
  EmbreeGroup(const EmbreeGroup&) = delete;
  EmbreeGroup& operator=(const EmbreeGroup&) = delete;

  RTCScene embreeScene() const { return scene_.get(); }
  const std::vector<PrimitiveId>& primitives() const { return primitives_; }
  bool empty() const { return empty_; }

  /// The hit that Embree found in this group's scene.
  Hit hit(const ClosestQuery&, const RTCHit& found) const;
  /// Starts to load what hit() will need.
  void prefetch(const RTCHit& found) const {
    if (found.geomID < 2) __builtin_prefetch(&layers_[found.geomID].triangles[found.primID]);
  }

 private:
  /// Opaque primitives, or panes.
  struct Layer {
    std::vector<TriangleRecord> triangles;
    std::vector<AnalyticRecord<SphereSurface>> spheres;
    std::vector<AnalyticRecord<CylinderSurface>> cylinders;
    std::vector<AnalyticRecord<ConeSurface>> cones;
    std::vector<AnalyticRecord<RingSurface>> rings;
    std::vector<AnalyticRecord<ThinTriangleSurface>> thinTriangles;
  };
  struct Collection;

  void attachTriangles(RTCDevice, Passage, const Collection&);
  template <class Surface>
  void attachAnalytic(RTCDevice, Passage, unsigned kind, std::vector<AnalyticRecord<Surface>>&);
  void attach(RTCGeometry, Passage, unsigned kind);

  std::vector<PrimitiveId> primitives_;
  std::array<Layer, 2> layers_;
  EmbreeScene scene_;
  bool empty_ = true;
};

}  // namespace deltalux
