#include "tracing/embree_group.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <variant>

#include "tracing/embree_callbacks.hpp"

namespace deltalux::tracing {

namespace {

enum Kind : unsigned { kTriangles, kSpheres, kCylinders, kCones, kRings, kThinTriangles };

/// Polygons narrower than this, relative to their coordinates, would lose their shape in single precision.
constexpr double kThin = 2e-4;                       // [rounding]
constexpr unsigned kRim = 2 * (kThinTriangles + 1);  // geometry, behind all others [layout]
constexpr unsigned geometryId(unsigned kind, Passage passage) { return 2 * kind + (passage == Passage::Pane ? 1 : 0); }

}  // namespace

/// Takes the shapes of primitives in, on their way into Embree's buffers and the layers' tables.
struct EmbreeGroup::Collection {
  Layer& layer;
  float extent;
  PrimitiveId id = PrimitiveId();
  std::vector<Vec3f> vertices = {};
  std::vector<std::array<std::uint32_t, 3>> indices = {};

  void operator()(const Polygon& polygon) {
    if (isThin(polygon)) {
      for (const auto& [a, b, c] : polygon.triangles)
        layer.thinTriangles.emplace_back(
            ThinTriangleSurface(polygon.vertices[a], polygon.vertices[b], polygon.vertices[c], polygon.normal), id,
            bounds(polygon), extent);
      return;
    }
    for (std::uint32_t t = 0; t < polygon.triangles.size(); ++t)
      layer.triangles.records.emplace_back(id, 0, polygon.normal, polygon.vertices[0]);
    addTriangles(polygon.vertices, polygon.triangles);
  }
  void operator()(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3& origin = mesh.positions[a];
      const Vec3 normal = glm::normalize(glm::cross(mesh.positions[b] - origin, mesh.positions[c] - origin));
      layer.triangles.records.emplace_back(id, t, normal, origin);
    }
    addTriangles(mesh.positions, mesh.triangles);
  }
  void operator()(const Sphere& s) { layer.spheres.emplace_back(SphereSurface(s), id, bounds(s), extent); }
  void operator()(const Cylinder& s) { layer.cylinders.emplace_back(CylinderSurface(s), id, bounds(s), extent); }
  void operator()(const Cone& s) { layer.cones.emplace_back(ConeSurface(s), id, bounds(s), extent); }
  void operator()(const Ring& s) { layer.rings.emplace_back(RingSurface(s), id, bounds(s), extent); }

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

EmbreeGroup::EmbreeGroup(RTCDevice device, const Scene& scene, std::vector<PrimitiveId> primitives, const Box& box,
                         float extent)
    : primitives_(std::move(primitives)), scene_(rtcNewScene(device)) {
  throwEmbreeError(device);
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // rays find no gap between neighbouring triangles
  for (const Passage passage : {Passage::Opaque, Passage::Pane}) {
    Layer& layer = layers_[passage == Passage::Pane ? 1 : 0];
    Collection collection{layer, extent};
    for (const PrimitiveId id : primitives_) {
      if (passesStraight(scene.materialOf(id)) != (passage == Passage::Pane) || !(area(scene[id].shape) > 0)) continue;
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
  if (!empty_) attachRim(device, box, extent);
  rtcCommitScene(scene_.get());
  throwEmbreeError(device);
}

namespace {

EmbreeGeometry triangleGeometry(RTCDevice device, std::span<const Vec3f> vertices,
                                std::span<const std::array<std::uint32_t, 3>> corners) {
  EmbreeGeometry geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE));
  auto* positions = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0,
                                                                RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices.size()));
  auto* indices = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(std::array<std::uint32_t, 3>), corners.size()));
  throwEmbreeError(device);
  std::ranges::copy(vertices, positions);
  std::ranges::copy(corners, indices);
  return geometry;
}

}  // namespace

void EmbreeGroup::attachRim(RTCDevice device, const Box& box, float extent) {
  const Vec3f margin(kRounding * extent);
  const std::array<Vec3f, 2> ends{Vec3f(box.lower) - margin, Vec3f(box.upper) + margin};
  const std::array<std::array<std::uint32_t, 3>, 2> corners{{{0, 0, 0}, {1, 1, 1}}};
  const EmbreeGeometry geometry = triangleGeometry(device, ends, corners);
  rtcSetGeometryIntersectFilterFunction(geometry.get(), nothingFilter);
  rtcSetGeometryOccludedFilterFunction(geometry.get(), nothingFilter);
  rtcSetGeometryMask(geometry.get(), static_cast<unsigned>(Passage::Opaque) | static_cast<unsigned>(Passage::Pane));
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(scene_.get(), geometry.get(), kRim);
}

void EmbreeGroup::attachTriangles(RTCDevice device, Passage passage, Collection& collection) {
  if (collection.indices.empty()) return;
  TriangleTable& table = collection.layer.triangles;
  for (const auto& corners : collection.indices) {
    BoxF& box = table.boxes.emplace_back();
    for (const std::uint32_t corner : corners) box.extend(collection.vertices[corner]);
  }
  const EmbreeGeometry geometry = triangleGeometry(device, collection.vertices, collection.indices);
  rtcSetGeometryUserData(geometry.get(), &table);
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

bool enters(const Vec3& origin, const Vec3& direction, const BoxF& box) {
  // Nodes are as much wider as three of these, of which roundings take less than two. (Embree 3.13.)
  constexpr double kSlack = std::numeric_limits<float>::epsilon();
  double begin = 0, end = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const double lower = box.lower[axis] - origin[axis], upper = box.upper[axis] - origin[axis];
    if (direction[axis] == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    const double a = lower / direction[axis], b = upper / direction[axis];
    begin = std::max(begin, std::min(a, b)), end = std::min(end, std::max(a, b));
  }
  return begin * (1 - kSlack) <= end * (1 + kSlack);
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
      return hitOn(layer.triangles.records[i], query);
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

}  // namespace deltalux::tracing
