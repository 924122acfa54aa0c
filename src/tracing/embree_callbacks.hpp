#pragma once
// What Embree calls back while it builds and traces: bounds, intersection and occlusion of user primitives, and filters
// on the triangles it finds. User data are the tables of records; contexts are ClosestQuery or PassageQuery.
#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>

#include "tracing/analytic_surface.hpp"
#include "tracing/embree_queries.hpp"
#include "tracing/embree_records.hpp"

namespace deltalux::tracing {

template <class Surface>
const AnalyticRecord<Surface>& recordOf(const void* userData, unsigned primitive) {
  return static_cast<const AnalyticRecord<Surface>*>(userData)[primitive];
}

/// One ray of a packet of N.
struct PacketRay {
  RTCRayN* rays;
  unsigned count, index;

  Vec3 origin() const {
    return {RTCRayN_org_x(rays, count, index), RTCRayN_org_y(rays, count, index), RTCRayN_org_z(rays, count, index)};
  }
  Vec3 direction() const {
    return {RTCRayN_dir_x(rays, count, index), RTCRayN_dir_y(rays, count, index), RTCRayN_dir_z(rays, count, index)};
  }
  float& tFar() const { return RTCRayN_tfar(rays, count, index); }
  bool reaches(float t) const { return t >= RTCRayN_tnear(rays, count, index) && t <= tFar(); }
};

template <class Surface>
void boundsCallback(const RTCBoundsFunctionArguments* args) {
  const auto& record = recordOf<Surface>(args->geometryUserPtr, args->primID);
  *args->bounds_o = {record.lower.x, record.lower.y, record.lower.z, 0,
                     record.upper.x, record.upper.y, record.upper.z, 0};
}

template <class Surface>
void intersectCallback(const RTCIntersectFunctionNArguments* args) {
  const auto& record = recordOf<Surface>(args->geometryUserPtr, args->primID);
  auto& query = *static_cast<ClosestQuery*>(args->context);
  const unsigned n = args->N;
  RTCHitN* hits = RTCRayHitN_HitN(args->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{RTCRayHitN_RayN(args->rayhit, n), n, i};
    const Vec3 origin = ray.origin(), direction = ray.direction();
    const Crossings crossings = record.surface.crossings(origin, direction);
    for (int k = 0; k < crossings.count; ++k) {
      const double t = crossings.t[static_cast<std::size_t>(k)];
      if (!query.take(t, &record.primitive)) continue;
      ray.tFar() = query.reach();
      RTCHitN_primID(hits, n, i) = args->primID;
      RTCHitN_geomID(hits, n, i) = args->geomID;
      RTCHitN_instID(hits, n, i, 0) = args->context->instID[0];
      break;
    }
  }
}

template <class Surface, Passage passage>
void occludedCallback(const RTCOccludedFunctionNArguments* args) {
  const AnalyticRecord<Surface>& record = recordOf<Surface>(args->geometryUserPtr, args->primID);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{args->ray, args->N, i};
    const Vec3 origin = ray.origin(), direction = ray.direction();
    const Crossings crossings = record.surface.crossings(origin, direction);
    bool blocked = false;
    float met = 0;
    for (int k = 0; k < crossings.count && !blocked; ++k) {
      const double t = crossings.t[static_cast<std::size_t>(k)];
      if (!ray.reaches(static_cast<float>(t))) continue;
      met = static_cast<float>(t);
      if constexpr (passage == Passage::Opaque) {
        blocked = true;
      } else {
        const double cosine = std::abs(glm::dot(record.surface.normal(origin + t * direction), direction));
        blocked = !static_cast<PassageQuery*>(args->context)->cross(record.primitive, static_cast<float>(t), cosine);
      }
    }
    if (!blocked) continue;
    auto& query = *static_cast<PassageQuery*>(args->context);
    query.blocker = record.primitive, query.blockedAt = met;
    ray.tFar() = -std::numeric_limits<float>::infinity();
  }
}

/// Whether a triangle was found as it would be in any tree: by a ray that enters its own box. Embree takes triangles
/// for hit by rays that pass their border at some distance, where those enter the node around them.
inline bool isFoundAnyway(const RTCFilterFunctionNArguments* args, unsigned i, const PacketRay& ray) {
  constexpr float kBorder = 0.01f;  // in barycentric coordinates, beyond which single precision does not err [rounding]
  const float u = RTCHitN_u(args->hit, args->N, i), v = RTCHitN_v(args->hit, args->N, i);
  if (std::min({u, v, 1 - u - v}) > kBorder) return true;
  const auto& table = *static_cast<const TriangleTable*>(args->geometryUserPtr);
  return enters(ray.origin(), ray.direction(), table.boxes[RTCHitN_primID(args->hit, args->N, i)]);
}

inline void nothingFilter(const RTCFilterFunctionNArguments* args) { std::fill_n(args->valid, args->N, 0); }

/// (That the ray's reach grows by a few digits over what Embree saw is more than its manual grants to filters, but what
/// its kernels heed.)
inline void closestFilter(const RTCFilterFunctionNArguments* args) {
  auto& query = *static_cast<ClosestQuery*>(args->context);
  const TriangleRecord* records = static_cast<const TriangleTable*>(args->geometryUserPtr)->records.data();
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{args->ray, args->N, i};
    if (isFoundAnyway(args, i, ray) && query.take(records[RTCHitN_primID(args->hit, args->N, i)], ray.tFar()))
      ray.tFar() = query.reach();
    else
      args->valid[i] = 0;
  }
}

/// Lets an occlusion query go on past triangles whose exact hit is off the segment, and through panes.
template <Passage passage>
void triangleFilter(const RTCFilterFunctionNArguments* args) {
  auto& query = *static_cast<PassageQuery*>(args->context);
  const TriangleRecord* records = static_cast<const TriangleTable*>(args->geometryUserPtr)->records.data();
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{args->ray, args->N, i};
    const TriangleRecord& record = records[RTCHitN_primID(args->hit, args->N, i)];
    const Vec3 origin = ray.origin(), direction = ray.direction();
    const auto t = static_cast<float>(record.meet(origin, direction, ray.tFar()));
    bool blocked = t >= query.segment.tNear && t <= query.segment.tFar && isFoundAnyway(args, i, ray);
    if constexpr (passage == Passage::Pane)
      blocked = blocked && !query.cross(record.primitive, t, std::abs(glm::dot(record.normal, direction)));
    if (blocked)
      query.blocker = record.primitive, query.blockedAt = t;
    else
      args->valid[i] = 0;
  }
}

}  // namespace deltalux::tracing
