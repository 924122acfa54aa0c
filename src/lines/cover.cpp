#include "lines/cover.hpp"

#include <algorithm>

#include "scene/stops_light.hpp"

namespace deltalux::lines {

namespace {

/// Distance at which a surface that lies on another covers it, relative to coordinates: eight times what the origin of
/// a ray is off by, so that rugs at floor level cover the floor.
constexpr float kContact = 8e-6f;  // [rounding]

float reachAt(const Vec3f& p) { return kContact * std::max(tracing::largestCoordinate(p), 1e-6f); }

std::vector<BoxF> boxesOf(const Scene& scene) {
  std::vector<BoxF> boxes;
  for (const Primitive& p : scene.primitives) {
    const Box b = bounds(p.shape);
    BoxF box;
    if (!b.empty()) box.lower = Vec3f(b.lower), box.upper = Vec3f(b.upper);
    boxes.push_back(box);
  }
  return boxes;
}

/// No more than the distance of a point from a shape: from its plane, or from what it is cut out of.
struct LeastDistance {
  Vec3 p;

  double operator()(const Polygon& s) const {
    return s.vertices.empty() ? 0.0 : std::abs(glm::dot(s.normal, p - s.vertices[0]));
  }
  double operator()(const Ring& s) const { return std::abs(glm::dot(s.normal, p - s.center)); }
  double operator()(const Sphere& s) const { return std::abs(glm::length(p - s.center) - s.radius); }
  double operator()(const Cylinder& s) const { return fromCone(s.p0, s.p1, s.radius, s.radius); }
  double operator()(const Cone& s) const { return fromCone(s.p0, s.p1, s.radius0, s.radius1); }
  double operator()(const Mesh&) const { return 0; }

 private:
  double fromCone(const Vec3& a, const Vec3& b, double r0, double r1) const {
    const Vec3 axis = b - a;
    const double length = glm::length(axis);
    if (!(length > 0)) return 0;
    const Vec3 d = p - a;
    const double along = glm::dot(d, axis) / length, widening = (r1 - r0) / length;
    const double across = std::sqrt(std::max(0.0, glm::dot(d, d) - along * along));
    return std::abs(across - r0 - widening * along) / std::sqrt(1 + widening * widening);
  }
};

/// Whether a shape may cover some area of another: flat ones where they are parallel, to within what a contact's
/// thickness over its width may be; curved ones only where both are of a kind.
bool mayLieOn(const Shape& other, const Shape& own, bool flat, const Vec3& normal) {
  constexpr double kParallel = 1 - 1e-5;  // [rounding]
  if (std::holds_alternative<Mesh>(other)) return true;
  const auto* polygon = std::get_if<Polygon>(&other);
  const auto* ring = std::get_if<Ring>(&other);
  if (!polygon && !ring) return !flat && other.index() == own.index();
  const Vec3 n = polygon ? polygon->normal : samplePoint(other, {0.5, 0.5}).normal;
  return flat ? std::abs(glm::dot(n, normal)) > kParallel
              : ring && std::holds_alternative<Ring>(own) && std::abs(glm::dot(n, normal)) > kParallel;
}

}  // namespace

Cover::Cover(const Scene& scene, const tracing::RayTracer& tracer)
    : scene_(scene), tracer_(tracer), boxes_(boxesOf(scene)), tree_(boxes_) {}

Cover::About Cover::about(const hierarchy::Elements& elements, hierarchy::ElementId leaf) const {
  const hierarchy::ElementGeometry& g = elements.shape(leaf);
  const float reach = reachAt(glm::max(glm::abs(g.lower), glm::abs(g.upper)));
  const PrimitiveId own = elements.domain[leaf.index()].primitive;
  const bool flat = elements.at(leaf).flat || g.normalCone >= 1;
  bool found = false;
  About all;
  tree_.overlapping({g.lower - reach, g.upper + reach}, [&](std::uint32_t i) {
    const PrimitiveId other(i);
    if (other == own) return;
    all.push_back(i);
    found = found || mayLieOn(scene_[other].shape, scene_[own].shape, flat, Vec3(g.normal));
  });
  if (!found) all.clear();
  return all;
}

/// Whether the short segment about `p` can meet any of them.
bool Cover::mayCover(const Vec3f& p, const About& about) const {
  const float reach = 2 * reachAt(p);
  const BoxF here{p - reach, p + reach};
  return std::any_of(about.begin(), about.end(), [&](std::uint32_t i) {
    return boxes_[i].overlaps(here) &&
           !(std::visit(LeastDistance{Vec3(p)}, scene_[PrimitiveId(i)].shape) > double(reach));
  });
}

bool Cover::isCovered(const Vec3f& p, const Vec3f& normal, PrimitiveId own) const {
  const float reach = reachAt(p);
  // Askew: a ray along an axis that runs in a face of a box of the tracer's tree may miss what is in it, so that what
  // it meets on an edge would depend on all else that is in the scene.
  const Vec3f askew(0.0031f, 0.0043f, 0.0037f);
  const Vec3f up = glm::normalize(normal + askew);
  tracing::Ray ray;
  ray.origin = p + reach * up, ray.direction = -up, ray.tFar = 2 * reach;
  const tracing::Hit hit = tracer_.closestHit(ray);
  return hit && hit.primitive != own && scene::stopsLight(scene_.materialOf(hit.primitive));
}

}  // namespace deltalux::lines
