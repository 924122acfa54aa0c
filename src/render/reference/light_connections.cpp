#include "render/reference/light_connections.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "render/reference/curved_mirror.hpp"

namespace deltalux {

namespace {

constexpr int kMaxMirrorConnections = 64;  // more would dilute the choice; the rest is found by scattering
constexpr int kFluxSamplesPlane = 256;     // a window-lit patch of a wide mirror must not be overlooked
constexpr int kFluxSamplesCurved = 32;

std::uint64_t pairKey(PrimitiveId mirror, LightId light) { return (std::uint64_t{mirror.value} << 32) | light.value; }

/// Plane of a flat mirror: a point and the unit normal of its front. nullopt for curved shapes and meshes.
struct Plane {
  Vec3 point, normal;
};
std::optional<Plane> planeOf(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return Plane{polygon->vertices.front(), polygon->normal};
  if (const auto* ring = std::get_if<Ring>(&shape)) return Plane{ring->center, glm::normalize(ring->normal)};
  return std::nullopt;
}

/// Whether the point `p` of the plane lies on the mirror.
bool contains(const Shape& shape, const Vec3& p) {
  if (const auto* ring = std::get_if<Ring>(&shape)) {
    const double r = glm::length(p - ring->center);
    return r >= ring->innerRadius && r <= ring->outerRadius;
  }
  const auto& polygon = std::get<Polygon>(shape);
  return std::any_of(polygon.triangles.begin(), polygon.triangles.end(), [&](const std::array<std::uint32_t, 3>& t) {
    const Vec3 &a = polygon.vertices[t[0]], &b = polygon.vertices[t[1]], &c = polygon.vertices[t[2]];
    const auto inside = [&](const Vec3& from, const Vec3& to) {
      return glm::dot(glm::cross(to - from, p - from), polygon.normal) >= 0.0;
    };
    return inside(a, b) && inside(b, c) && inside(c, a);
  });
}

Vec3 mirrorImage(const Plane& plane, const Vec3& x) { return x - 2.0 * glm::dot(x - plane.point, plane.normal) * plane.normal; }

Ray shadowRay(const Vec3& from, const Vec3& fromNormal, const Vec3& direction, double distance, const Vec3& toNormal) {
  const Vec3f origin(from), normal(fromNormal), d(direction);
  if (!std::isinf(distance)) {
    Ray ray = segment(origin, normal, Vec3f(from + distance * direction), Vec3f(toNormal));
    // A point-like light may sit right on a ceiling, which must not hide it.
    if (toNormal == Vec3(0)) ray.tFar *= 1.0f - 1e-5f;
    return ray;
  }
  Ray ray;
  ray.origin = offsetOrigin(origin, normal, d);
  ray.direction = d;
  return ray;
}

bool isSky(const Scene& scene, LightId light) { return std::holds_alternative<DomeLight>(scene[light].emitter); }

float reciprocal(double pdf) { return pdf > 0.0 ? static_cast<float>(1.0 / pdf) : 1.0f; }

}  // namespace

LightConnections::LightConnections(const ReferenceScene& scene) : scene_(scene) {
  for (std::size_t i = 0; i < scene.scene().lights.size(); ++i) {
    const LightId light(i);
    const Scene& values = scene.scene();
    const bool dark = std::holds_alternative<AreaLight>(values[light].emitter) && scene.lights().area(light) <= 0.0;
    straight_.push_back(dark || isBlack(values[light].scale) ? -1 : static_cast<int>(list_.size()));
    if (straight_.back() >= 0) list_.push_back({Connection::Kind::Straight, light, {}, 0});
  }
  addMirrors();
}

int LightConnections::straight(LightId light) const { return straight_[light.index()]; }

int LightConnections::mirrored(PrimitiveId mirror, LightId light) const {
  const auto it = mirrored_.find(pairKey(mirror, light));
  return it == mirrored_.end() ? -1 : it->second;
}

void LightConnections::addMirrors() {
  const Scene& scene = scene_.scene();
  std::vector<Connection> candidates;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const PrimitiveId p(i);
    const bool flat = planeOf(scene[p].shape).has_value();
    if (!flat && !isCurvedMirror(scene[p].shape)) continue;
    if (isBlack(mirrorReflectance(scene_.bsdf(p, true), 0.5)) && isBlack(mirrorReflectance(scene_.bsdf(p, false), 0.5))) continue;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      if (straight(LightId(l)) < 0 || isSky(scene, LightId(l))) continue;
      candidates.push_back({flat ? Connection::Kind::Plane : Connection::Kind::Curved, LightId(l), p, 0});
    }
  }
  parallelFor(candidates.size(), 16, [&](std::size_t i) {
    Connection& c = candidates[i];
    c.flux = mirroredFlux(c.mirror, c.light, c.kind == Connection::Kind::Plane ? kFluxSamplesPlane : kFluxSamplesCurved);
  });
  std::erase_if(candidates, [](const Connection& c) { return !(c.flux > 0.0); });
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.flux > b.flux; });
  if (candidates.size() > kMaxMirrorConnections) candidates.resize(kMaxMirrorConnections);
  for (const Connection& c : candidates) {
    mirrored_[pairKey(c.mirror, c.light)] = static_cast<int>(list_.size());
    list_.push_back(c);
  }
}

double LightConnections::mirroredFlux(PrimitiveId mirror, LightId light, int samples) const {
  const Shape& shape = scene_.scene()[mirror].shape;
  Rng rng(pairKey(mirror, light));
  double flux = 0;
  for (int i = 0; i < samples; ++i) {
    const SurfacePoint p = samplePoint(shape, {rng.uniform(), rng.uniform()});
    const Vec2 u(rng.uniform(), rng.uniform());
    const auto s = scene_.lights().sample(light, p.position, u);
    if (!s) continue;
    const double cosine = glm::dot(s->direction, p.normal);
    const Rgb R = mirrorReflectance(scene_.bsdf(mirror, cosine > 0.0), std::abs(cosine));
    if (isBlack(R)) continue;
    const Rgb T = scene_.rays().transmittance(shadowRay(p.position, p.normal, s->direction, s->distance, s->normal));
    flux += gray(R * T * s->radiance) * std::abs(cosine) * reciprocal(s->pdf);
  }
  return flux * area(shape) / samples;
}

Arrivals LightConnections::sample(int connection, const Vec3& x, const Vec3& n, const Vec2& u) const {
  const Connection& c = list_[connection];
  Arrivals arrivals;
  if (c.kind == Connection::Kind::Straight) sampleStraight(c, x, n, u, arrivals);
  if (c.kind == Connection::Kind::Plane) samplePlane(c, x, n, u, arrivals);
  if (c.kind == Connection::Kind::Curved) sampleCurved(c, x, n, u, arrivals);
  return arrivals;
}

void LightConnections::sampleStraight(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals& out) const {
  const auto s = scene_.lights().sample(c.light, x, u);
  if (!s) return;
  Arrival& a = out.list[out.count++];
  a.direction = s->direction;
  a.value = s->radiance * reciprocal(s->pdf);
  a.pdf = s->pdf;
  a.first = shadowRay(x, n, s->direction, s->distance, s->normal);
}

void LightConnections::samplePlane(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals& out) const {
  const Shape& shape = scene_.scene()[c.mirror].shape;
  const Plane plane = *planeOf(shape);
  const double height = glm::dot(x - plane.point, plane.normal);
  if (!scene_.isConnectableMirror(c.mirror, height > 0.0)) return;
  const Bsdf& bsdf = scene_.bsdf(c.mirror, height > 0.0);
  const Vec3 image = mirrorImage(plane, x);
  const auto s = scene_.lights().sample(c.light, image, u);
  if (!s) return;
  const double slope = glm::dot(s->direction, plane.normal);
  const double t = height / slope;  // from the image, which is as far behind the plane as x is before it
  if (!(t > 0.0) || !(t < s->distance)) return;
  const Vec3 on = image + t * s->direction;
  if (!contains(shape, on)) return;
  Rgb L = s->radiance;
  // The spotlight rule counts the distance to the first surface, which is the mirror.
  if (scene_.lights().area(c.light) > 0.0) L = scene_.lights().emittedRadiance(c.light, -s->direction, s->distance - t, true);
  Arrival& a = out.list[out.count++];
  a.direction = s->direction - 2.0 * slope * plane.normal;
  a.value = L * mirrorReflectance(bsdf, std::abs(slope)) * reciprocal(s->pdf);
  a.pdf = s->pdf;
  a.first = shadowRay(x, n, a.direction, t, plane.normal);
  a.second = shadowRay(on, plane.normal, s->direction, s->distance - t, s->normal);
  a.rays = 2;
}

void LightConnections::sampleCurved(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u, Arrivals& out) const {
  const Scene& scene = scene_.scene();
  const Shape& shape = scene[c.mirror].shape;
  const LightSampler& lights = scene_.lights();
  const double lightArea = lights.area(c.light);
  const bool sun = std::holds_alternative<SunLight>(scene[c.light].emitter);
  LightPlace place{Vec3(0), sun};
  Vec3 lightNormal(0);
  if (lightArea > 0.0) {
    const SurfacePoint p = lights.samplePoint(c.light, u);
    place.at = p.position, lightNormal = p.normal;
  } else {
    // The directions of a sun, or the position of a point-like light, are the same from everywhere.
    const auto s = lights.sample(c.light, x, u);
    if (sun && !s) return;
    place.at = sun ? s->direction : lights.position(c.light);
  }
  const MirrorPoints points = mirrorPoints(shape, x, place);
  for (int i = 0; i < points.count; ++i) {
    const MirrorPoint& m = points.points[i];
    if (!scene_.isConnectableMirror(c.mirror, m.front)) continue;
    const Vec3 toLight = sun ? place.at : place.at - m.position;
    const double after = sun ? kInfinity : glm::length(toLight);
    const Vec3 onward = sun ? toLight : toLight / after;
    const double spread = reflectedSpread(shape, x, m.position, after);
    Arrival a;
    const Vec3 d = m.position - x;
    const double before = glm::length(d);
    a.direction = d / before;
    const double cosine = std::abs(glm::dot(a.direction, m.normal));
    Rgb value(0.0f);
    Vec3 normal = lightNormal;
    if (sun) {
      value = lights.radianceFrom(c.light, onward);
      a.pdf = spread / solidAngle(std::get<SunLight>(scene[c.light].emitter));
    } else if (lightArea > 0.0) {
      const double cosLight = -glm::dot(onward, lightNormal);
      value = lights.emittedRadiance(c.light, -onward, after, cosLight > 0.0);
      if (cosLight < 0.0) normal = -normal;
      a.pdf = cosLight != 0.0 ? spread / (lightArea * std::abs(cosLight)) : 0.0;
    } else {
      value = lights.intensity(c.light, -onward) * static_cast<float>(1.0 / spread);
    }
    if (isBlack(value) || !(spread > 0.0)) continue;
    a.value = value * mirrorReflectance(scene_.bsdf(c.mirror, m.front), cosine) * reciprocal(a.pdf);
    a.first = shadowRay(x, n, a.direction, before, m.normal);
    a.second = shadowRay(m.position, m.normal, onward, after, normal);
    a.rays = 2;
    out.list[out.count++] = a;
  }
}

double LightConnections::pdf(int connection, const LightMeeting& m) const {
  const Connection& c = list_[connection];
  const LightSampler& lights = scene_.lights();
  const Shape* shape = c.mirror.valid() ? &scene_.scene()[c.mirror].shape : nullptr;
  if (c.kind == Connection::Kind::Straight) return lights.pdf(c.light, m.from, m.direction, m.distance, m.normal);
  if (c.kind == Connection::Kind::Plane) {
    return lights.pdf(c.light, mirrorImage(*planeOf(*shape), m.from), m.direction, m.distance, m.normal);
  }
  if (const auto* sun = std::get_if<SunLight>(&scene_.scene()[c.light].emitter)) {
    return reflectedSpread(*shape, m.from, m.mirrorPoint, kInfinity) / solidAngle(*sun);
  }
  const double after = m.distance - glm::length(m.mirrorPoint - m.from);
  const double cosine = std::abs(glm::dot(m.direction, m.normal));
  return cosine > 0.0 ? reflectedSpread(*shape, m.from, m.mirrorPoint, after) / (lights.area(c.light) * cosine) : 0.0;
}

}  // namespace deltalux
