#include "tracing/embree_group.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace deltalux {

namespace {

enum Kind : unsigned { kTriangles, kSpheres, kCylinders, kCones, kRings, kThinTriangles };

/// Polygons narrower than this, relative to their coordinates, would lose their shape in single precision.
constexpr double kThin = 2e-4;
/// Rays closer than this to the plane of a triangle keep the t that Embree saw: the plane hardly tells.
constexpr double kGrazing = 1e-6;

constexpr unsigned geometryId(unsigned kind, Passage passage) { return 2 * kind + (passage == Passage::Pane ? 1 : 0); }

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
    for (int k = 0; k < crossings.count && !blocked; ++k) {
      const double t = crossings.t[static_cast<std::size_t>(k)];
      if (!ray.reaches(static_cast<float>(t))) continue;
      if constexpr (passage == Passage::Opaque) {
        blocked = true;
      } else {
        const double cosine = std::abs(glm::dot(record.surface.normal(origin + t * direction), direction));
        blocked = !static_cast<PassageQuery*>(args->context)->cross(record.primitive, static_cast<float>(t), cosine);
      }
    }
    if (blocked) ray.tFar() = -std::numeric_limits<float>::infinity();
  }
}

/// (That the ray's reach grows by a few digits over what Embree saw is more than its manual grants to filters, but what
/// its kernels heed.)
void closestFilter(const RTCFilterFunctionNArguments* args) {
  auto& query = *static_cast<ClosestQuery*>(args->context);
  const auto* records = static_cast<const TriangleRecord*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{args->ray, args->N, i};
    if (query.take(records[RTCHitN_primID(args->hit, args->N, i)], ray.tFar()))
      ray.tFar() = query.reach();
    else
      args->valid[i] = 0;
  }
}

/// Lets an occlusion query go on past triangles whose exact hit is off the segment, and through panes.
template <Passage passage>
void triangleFilter(const RTCFilterFunctionNArguments* args) {
  auto& query = *static_cast<PassageQuery*>(args->context);
  const auto* records = static_cast<const TriangleRecord*>(args->geometryUserPtr);
  for (unsigned i = 0; i < args->N; ++i) {
    if (!args->valid[i]) continue;
    const PacketRay ray{args->ray, args->N, i};
    const TriangleRecord& record = records[RTCHitN_primID(args->hit, args->N, i)];
    const Vec3 origin = ray.origin(), direction = ray.direction();
    const auto t = static_cast<float>(record.meet(origin, direction, ray.tFar()));
    bool blocked = t >= query.segment.tNear && t <= query.segment.tFar;
    if constexpr (passage == Passage::Pane)
      blocked = blocked && !query.cross(record.primitive, t, std::abs(glm::dot(record.normal, direction)));
    if (!blocked) args->valid[i] = 0;
  }
}

}  // namespace

ClosestQuery::ClosestQuery(const Ray& ray)
    : ray_(&ray), originSize_(std::max({std::abs(ray.origin.x), std::abs(ray.origin.y), std::abs(ray.origin.z)})) {
  rtcInitIntersectContext(this);
}

double ClosestQuery::settled() const {
  const double t = unsettled_->meet(Vec3(ray_->origin), Vec3(ray_->direction), static_cast<float>(nearest_));
  return t >= ray_->tNear && t <= ray_->tFar ? t : nearest_;
}

bool ClosestQuery::take(double t, const PrimitiveId* id) {
  const auto rounded = static_cast<float>(t);
  if (!(rounded >= ray_->tNear && rounded <= ray_->tFar)) return false;
  if (unsettled_ && t + doubt(rounded) > nearest_) nearest_ = settled(), unsettled_ = nullptr;
  const auto best = static_cast<float>(nearest_);
  if (rounded > best) return false;
  if (rounded == best && holder_ && (*holder_ < *id || (*holder_ == *id && holder_ < id))) return false;
  nearest_ = t, holder_ = id, unsettled_ = nullptr;
  return true;
}

bool ClosestQuery::take(const TriangleRecord& record, float seen) {
  const float d = doubt(seen);
  const bool clear = seen - d > ray_->tNear && seen + d < ray_->tFar && seen + d < nearest_;
  if (!clear) return take(record.meet(Vec3(ray_->origin), Vec3(ray_->direction), seen), &record.primitive);
  nearest_ = seen, holder_ = &record.primitive, unsettled_ = &record;
  return true;
}

float ClosestQuery::reach() const {
  const auto t = static_cast<float>(nearest_);
  return std::min(t + doubt(t), ray_->tFar);
}

bool PassageQuery::isRepeat(const Crossed& crossed) const {
  // A flat pane is crossed once; others are met twice at one place only on an edge between two of their triangles.
  const bool flat = std::holds_alternative<Polygon>(scene[crossed.pane].shape);
  const auto same = [&](const Crossed& other) {
    return other.pane == crossed.pane && (flat || std::abs(other.t - crossed.t) <= 4e-6f * std::abs(crossed.t));
  };
  const auto end = few_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kFew));
  return std::any_of(few_.begin(), end, same) || std::any_of(more_.begin(), more_.end(), same);
}

bool PassageQuery::cross(PrimitiveId pane, float t, double cosIncidence) {
  const Crossed crossed{pane, t};
  if (isRepeat(crossed)) return true;
  if (count_ < kFew)
    few_[count_] = crossed;
  else
    more_.push_back(crossed);
  ++count_;
  passed *= transmittance(std::get<ThinGlass>(scene.materialOf(pane).surface), std::clamp(cosIncidence, 1e-6, 1.0));
  return !isBlack(passed);
}

TriangleRecord::TriangleRecord(PrimitiveId id, std::uint32_t t, const Vec3& n, const Vec3& point)
    : normal(n), offset(glm::dot(n, point)), primitive(id), triangle(t) {}

double TriangleRecord::meet(const Vec3& origin, const Vec3& direction, float seen) const {
  const double cosine = glm::dot(normal, direction);
  return std::abs(cosine) > kGrazing ? (offset - glm::dot(normal, origin)) / cosine : seen;
}

template <class Surface>
AnalyticRecord<Surface>::AnalyticRecord(const Surface& s, PrimitiveId id, const Box& box) : surface(s), primitive(id) {
  // Wider than the box by what rounding may take, also on the ray's side of the comparison.
  const Vec3 margin = 4e-7 * glm::max(glm::abs(box.lower), glm::abs(box.upper));
  lower = Vec3f(box.lower - margin), upper = Vec3f(box.upper + margin);
}

/// Takes the shapes of primitives in, on their way into Embree's buffers and the layers' tables.
struct EmbreeGroup::Collection {
  Layer& layer;
  PrimitiveId id = PrimitiveId();
  std::vector<Vec3f> vertices = {};
  std::vector<std::array<std::uint32_t, 3>> indices = {};

  void operator()(const Polygon& polygon) {
    if (isThin(polygon)) {
      for (const auto& [a, b, c] : polygon.triangles)
        layer.thinTriangles.emplace_back(
            ThinTriangleSurface(polygon.vertices[a], polygon.vertices[b], polygon.vertices[c], polygon.normal), id,
            bounds(polygon));
      return;
    }
    for (std::uint32_t t = 0; t < polygon.triangles.size(); ++t)
      layer.triangles.emplace_back(id, 0, polygon.normal, polygon.vertices[0]);
    addTriangles(polygon.vertices, polygon.triangles);
  }
  void operator()(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3& origin = mesh.positions[a];
      const Vec3 normal = glm::normalize(glm::cross(mesh.positions[b] - origin, mesh.positions[c] - origin));
      layer.triangles.emplace_back(id, t, normal, origin);
    }
    addTriangles(mesh.positions, mesh.triangles);
  }
  void operator()(const Sphere& s) { layer.spheres.emplace_back(SphereSurface(s), id, bounds(s)); }
  void operator()(const Cylinder& s) { layer.cylinders.emplace_back(CylinderSurface(s), id, bounds(s)); }
  void operator()(const Cone& s) { layer.cones.emplace_back(ConeSurface(s), id, bounds(s)); }
  void operator()(const Ring& s) { layer.rings.emplace_back(RingSurface(s), id, bounds(s)); }

 private:
  /// Area over length: the width of a strip.
  static bool isThin(const Polygon& polygon) {
    const Box box = bounds(polygon);
    const Vec3 far = glm::max(glm::abs(box.lower), glm::abs(box.upper));
    return polygon.area < kThin * std::max({far.x, far.y, far.z}) * box.diagonal();
  }

  void addTriangles(const std::vector<Vec3>& positions, const std::vector<std::array<std::uint32_t, 3>>& corners) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Vec3& p : positions) vertices.emplace_back(p);
    for (const auto& [a, b, c] : corners) indices.push_back({first + a, first + b, first + c});
  }
};

EmbreeGroup::EmbreeGroup(RTCDevice device, const Scene& scene, std::vector<PrimitiveId> primitives)
    : primitives_(std::move(primitives)), scene_(rtcNewScene(device)) {
  throwEmbreeError(device);
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // rays find no gap between neighbouring triangles
  for (const Passage passage : {Passage::Opaque, Passage::Pane}) {
    Layer& layer = layers_[passage == Passage::Pane ? 1 : 0];
    Collection collection{layer};
    for (const PrimitiveId id : primitives_) {
      if (isThinGlass(scene.materialOf(id)) != (passage == Passage::Pane) || !(area(scene[id].shape) > 0)) continue;
      collection.id = id;
      std::visit(collection, scene[id].shape);
    }
    attachTriangles(device, passage, collection);
    attachAnalytic(device, passage, kSpheres, layer.spheres);
    attachAnalytic(device, passage, kCylinders, layer.cylinders);
    attachAnalytic(device, passage, kCones, layer.cones);
    attachAnalytic(device, passage, kRings, layer.rings);
    attachAnalytic(device, passage, kThinTriangles, layer.thinTriangles);
  }
  rtcCommitScene(scene_.get());
  throwEmbreeError(device);
}

void EmbreeGroup::attachTriangles(RTCDevice device, Passage passage, const Collection& collection) {
  if (collection.indices.empty()) return;
  const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3f), collection.vertices.size()));
  auto* indices = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(std::array<std::uint32_t, 3>), collection.indices.size()));
  throwEmbreeError(device);
  std::copy(collection.vertices.begin(), collection.vertices.end(), vertices);
  std::copy(collection.indices.begin(), collection.indices.end(), indices);
  rtcSetGeometryUserData(geometry.get(), collection.layer.triangles.data());
  rtcSetGeometryIntersectFilterFunction(geometry.get(), closestFilter);
  rtcSetGeometryOccludedFilterFunction(
      geometry.get(), passage == Passage::Pane ? triangleFilter<Passage::Pane> : triangleFilter<Passage::Opaque>);
  attach(geometry.get(), passage, kTriangles);
}

template <class Surface>
void EmbreeGroup::attachAnalytic(RTCDevice device, Passage passage, unsigned kind,
                                 std::vector<AnalyticRecord<Surface>>& records) {
  if (records.empty()) return;
  const EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER));
  throwEmbreeError(device);
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(records.size()));
  rtcSetGeometryUserData(geometry.get(), records.data());
  rtcSetGeometryBoundsFunction(geometry.get(), boundsCallback<Surface>, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), intersectCallback<Surface>);
  rtcSetGeometryOccludedFunction(geometry.get(), passage == Passage::Pane ? occludedCallback<Surface, Passage::Pane>
                                                                          : occludedCallback<Surface, Passage::Opaque>);
  attach(geometry.get(), passage, kind);
}

void EmbreeGroup::attach(RTCGeometry geometry, Passage passage, unsigned kind) {
  rtcSetGeometryMask(geometry, static_cast<unsigned>(passage));
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(scene_.get(), geometry, geometryId(kind, passage));
  empty_ = false;
}

namespace {

Hit hitAt(const ClosestQuery& query, double t, const Vec3& position, const Vec3& normal) {
  Hit hit;
  hit.t = static_cast<float>(t);
  hit.primitive = query.primitive();
  hit.position = Vec3f(position);
  hit.normal = Vec3f(normal);
  hit.front = glm::dot(normal, Vec3(query.ray().direction)) < 0;
  return hit;
}

Vec3 pointAt(const Ray& ray, double t) { return Vec3(ray.origin) + t * Vec3(ray.direction); }

template <class Surface>
Hit hitOn(const AnalyticRecord<Surface>& record, const ClosestQuery& query) {
  const double t = query.exact();
  const Vec3 p = pointAt(query.ray(), t);
  return hitAt(query, t, p, record.surface.normal(p));
}

Hit hitOn(const TriangleRecord& record, const ClosestQuery& query) {
  const double t = query.exact();
  const Vec3 p = pointAt(query.ray(), t);
  const double elevation = glm::dot(record.normal, p) - record.offset;  // not 0 on grazing rays
  Hit hit = hitAt(query, t, p - elevation * record.normal, record.normal);
  hit.triangle = record.triangle;
  return hit;
}

}  // namespace

Hit EmbreeGroup::hit(const ClosestQuery& query, const RTCHit& found) const {
  const Layer& layer = layers_[found.geomID % 2];
  const unsigned i = found.primID;
  switch (found.geomID / 2) {
    case kTriangles:
      return hitOn(layer.triangles[i], query);
    case kSpheres:
      return hitOn(layer.spheres[i], query);
    case kCylinders:
      return hitOn(layer.cylinders[i], query);
    case kCones:
      return hitOn(layer.cones[i], query);
    case kRings:
      return hitOn(layer.rings[i], query);
    default:
      return hitOn(layer.thinTriangles[i], query);
  }
}

}  // namespace deltalux
