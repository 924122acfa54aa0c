#pragma once
// What a query carries through Embree to the callbacks, in place of Embree's context.
#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <deltalux/scene.hpp>
#include <limits>
#include <vector>

#include "tracing/embree_records.hpp"
#include "tracing/ray.hpp"

namespace deltalux::tracing {

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
  double exact() const { return approximate_ ? refined() : nearest_; }
  PrimitiveId primitive() const { return *holder_; }

 private:
  double refined() const;
  float doubt(float t) const { return kDoubt * (originSize_ + t); }

  static constexpr float kDoubt =
      2e-4f;  // of the coordinates: single precision's, along rather grazing rays [rounding]
  const Ray* ray_;
  float originSize_;
  double nearest_ = std::numeric_limits<double>::infinity();
  const PrimitiveId* holder_ = nullptr;
  const TriangleRecord* approximate_ = nullptr;  // whose t is as Embree saw it
};

/// What an occlusion query knows besides its ray: panes on the way multiply `passed` instead of ending the query.
struct PassageQuery : RTCIntersectContext {
  PassageQuery(const Scene& s, const Ray& ray) : scene(s), segment(ray) { rtcInitIntersectContext(this); }

  /// Counts the pane once, though a ray may meet it in two triangles that share an edge. False when no light is left.
  bool cross(PrimitiveId pane, float t, double cosIncidence);

  const Scene& scene;
  const Ray& segment;
  Rgb passed{1.0f};
  PrimitiveId blocker;  // what ended it, if anything did
  float blockedAt = 0;  // and where

 private:
  struct Crossed {
    PrimitiveId pane;
    float t;
  };
  bool isRepeat(const Crossed&) const;

  static constexpr std::size_t kFew = 8;  // [task]
  std::array<Crossed, kFew> few_;
  std::vector<Crossed> more_;  // beyond the few
  std::size_t count_ = 0;
};

inline bool ClosestQuery::take(const TriangleRecord& record, float seen) {
  const float d = doubt(seen);
  const bool clear = seen - d > ray_->tNear && seen + d < ray_->tFar && seen + d < nearest_;
  if (!clear) return take(record.meet(Vec3(ray_->origin), Vec3(ray_->direction), seen), &record.primitive);
  nearest_ = seen, holder_ = &record.primitive, approximate_ = &record;
  return true;
}

inline float ClosestQuery::reach() const {
  const auto t = static_cast<float>(nearest_);
  return std::min(t + doubt(t), ray_->tFar);
}

}  // namespace deltalux::tracing
