#include "render/reference/path_tracer.hpp"

#include <cmath>

#include "base/tuning.hpp"
#include "render/tuning.hpp"

namespace deltalux::rendering {

namespace {

/// Weight of a strategy with density p against one with density q. [Veach97]
double powerHeuristic(double p, double q) {
  const double ratio = q / p;
  return 1.0 / (1.0 + ratio * ratio);
}

/// A white Lambertian receiver: what it scatters is irradiance over pi.
const scene::Bsdf& meter() {
  static const scene::Bsdf bsdf = [] {
    scene::Bsdf b;
    b.diffuseReflection = Rgb(1.0f);
    return b;
  }();
  return bsdf;
}

Rgb passed(const Dielectric* medium, double distance) {
  if (!medium) return Rgb(1.0f);
  return glm::pow(medium->transmission, Rgb(static_cast<float>(distance)));
}

}  // namespace

PathTracer::PathTracer(const ReferenceScene& scene, const LightConnections& connections, const ConnectionTable& table,
                       int maxDepth, KnownRadiance known)
    : scene_(scene), connections_(connections), table_(table), maxDepth_(maxDepth), known_(std::move(known)) {}

RgbSum PathTracer::irradiance(const Vec3& position, const Vec3& normal, PathSampler& sampler,
                              std::uint64_t& rays) const {
  const PathVertex vertex{position, normal, normal, &meter(), nullptr};
  RgbSum sum(connect(vertex, tuning::kMeterConnections, sampler, rays));
  Walk walk;
  if (scatter(walk, vertex, PrimitiveId(), true, sampler)) {
    walk.anchor.connections = tuning::kMeterConnections;
    sum += follow(walk, sampler, rays);
  }
  return sum * kPi;
}

RgbSum PathTracer::radiance(const Vec3& origin, const Vec3& direction, PathSampler& sampler,
                            std::uint64_t& rays) const {
  Walk walk;
  walk.origin = origin, walk.direction = direction, walk.offsetNormal = Vec3(0);
  return follow(walk, sampler, rays);
}

RgbSum PathTracer::follow(Walk walk, PathSampler& sampler, std::uint64_t& rays) const {
  RgbSum sum(0);
  while (true) {
    tracing::Ray ray;
    ray.direction = Vec3f(walk.direction);
    ray.origin = tracing::offsetOrigin(Vec3f(walk.origin), Vec3f(walk.offsetNormal), ray.direction);
    const tracing::Hit hit = scene_.rays().closestHit(ray);
    ++rays;
    if (!hit) return sum + lightAtInfinity(walk);
    walk.anchor.distance += hit.t, walk.anchor.fromSurface += hit.t;
    walk.throughput *= passed(walk.medium, hit.t);
    sum += walk.throughput * lightOf(walk, hit.primitive, hit);

    const Vec3 normal = glm::normalize(Vec3(hit.normal)) * (hit.front ? 1.0 : -1.0);
    PathVertex vertex{Vec3(hit.position), normal, -walk.direction, &scene_.bsdf(hit.primitive, hit.front), walk.medium};
    scene::Bsdf own;
    if (known_) {
      sum += walk.throughput * known_(hit);
      own = scene::specularPart(*vertex.bsdf);
      vertex.bsdf = &own;
    } else if (scene_.isTextured(hit.primitive)) {
      own = *vertex.bsdf;
      own.diffuseReflection *= scene_.tint(hit.primitive, hit.triangle, vertex.position);
      vertex.bsdf = &own;
    }
    if (maxDepth_ > 0 && walk.depth >= maxDepth_) return sum;
    if (vertex.bsdf->hasFinitePart()) sum += walk.throughput * connect(vertex, 1, sampler, rays);
    if (!scatter(walk, vertex, hit.primitive, hit.front, sampler)) return sum;
  }
}

Rgb PathTracer::connect(const PathVertex& v, int count, PathSampler& sampler, std::uint64_t& rays) const {
  const double which = sampler.next1();
  Rgb sum(0.0f);
  for (int i = 0; i < count; ++i) {
    const Vec2 u = sampler.next2();
    const ConnectionTable::Choice choice = table_.choose(v.position, v.normal, (i + which) / count);
    if (choice.connection >= 0) sum += arriving(v, choice, count, u, rays);
  }
  return sum;
}

Rgb PathTracer::arriving(const PathVertex& v, const ConnectionTable::Choice& choice, int count, const Vec2& u,
                         std::uint64_t& rays) const {
  // Within a body only straight connections know how much it absorbs.
  if (v.medium && connections_.list()[choice.connection].chain.count > 0) return Rgb(0.0f);
  const Frame frame(v.normal);
  const Vec3 wo = frame.toLocal(v.wo);
  const double tries = count * choice.chance;
  Rgb sum(0.0f);
  const Arrivals arrivals = connections_.sample(choice.connection, v.position, v.normal, u);
  for (int i = 0; i < arrivals.count; ++i) {
    const Arrival& a = arrivals.list[i];
    const Vec3 wi = frame.toLocal(a.direction);
    const Rgb f = scene::evaluate(*v.bsdf, wo, wi);
    if (isBlack(f)) continue;
    Rgb T = passed(v.medium, a.legs[0].tFar);
    for (int l = 0; l < a.legCount && !isBlack(T); ++l) T *= scene_.rays().transmittance(a.legs[l]), ++rays;
    if (isBlack(T)) continue;
    const double weight = a.pdf > 0.0 ? powerHeuristic(tries * a.pdf, pdf(*v.bsdf, wo, wi)) : 1.0;
    sum += f * a.value * T * static_cast<float>(weight / tries);
  }
  return sum;
}

bool PathTracer::scatter(Walk& walk, const PathVertex& v, PrimitiveId primitive, bool front,
                         PathSampler& sampler) const {
  const Frame frame(v.normal);
  const double part = sampler.next1();
  const Vec2 u = sampler.next2();
  const auto s = scene::sample(*v.bsdf, frame.toLocal(v.wo), {part, u.x, u.y});
  if (!s) return false;
  walk.throughput *= s->weight * static_cast<float>(1.0 / s->etaSquared);
  walk.origin = v.position, walk.offsetNormal = v.normal;
  walk.direction = glm::normalize(frame.toWorld(s->direction));

  follow(walk.anchor, v, *s, primitive, front);
  if (s->event == scene::ScatterEvent::Refraction) walk.medium = front ? scene_.body(primitive) : nullptr;

  ++walk.depth;
  if (walk.depth <= deltalux::tuning::kRouletteFrom) return true;
  const double survival = std::min<double>(deltalux::tuning::kMostSurvival, maxChannel(walk.throughput));
  if (!(sampler.next1() < survival)) return false;
  walk.throughput *= static_cast<float>(1.0 / survival);
  return true;
}

/// Keeps the anchor's account of how the path went on from it.
void PathTracer::follow(Anchor& anchor, const PathVertex& v, const scene::BsdfSample& s, PrimitiveId primitive,
                        bool front) const {
  if (s.event == scene::ScatterEvent::Passage) return;
  anchor.fromSurface = 0;
  if (!scene::isDirac(s.event)) {
    anchor = {v.position, v.normal, 1, s.pdf, Anchor::Since::Connectable, {}, Vec3(0), 0.0, 0.0};
    return;
  }
  if (anchor.since == Anchor::Since::Camera) return;
  const auto addBend = [&](const std::optional<Bend>& bend) {
    if (!bend || (bend->kind != Bend::Kind::Plane && anchor.chain.curved() >= 0) || !anchor.chain.add(*bend))
      return false;
    if (bend->kind != Bend::Kind::Plane) anchor.bendPoint = v.position;
    return true;
  };
  const bool refracted = s.event == scene::ScatterEvent::Refraction;
  if (anchor.since == Anchor::Since::InBall) {
    Bend& bend = anchor.chain.bends[anchor.chain.count - 1];
    if (bend.surface != primitive || front) {
      anchor.since = Anchor::Since::Unconnectable;
    } else if (refracted) {
      anchor.since = Anchor::Since::Connectable;
    } else if (const auto further = connections_.ball(primitive, bend.inner + 1)) {
      bend = *further;
    } else {
      anchor.since = Anchor::Since::Unconnectable;
    }
  } else if (anchor.since == Anchor::Since::Connectable && !v.medium &&
             s.event == scene::ScatterEvent::MirrorReflection) {
    if (!addBend(connections_.mirror(primitive, front))) anchor.since = Anchor::Since::Unconnectable;
  } else if (anchor.since == Anchor::Since::Connectable && !v.medium && refracted && front) {
    anchor.since = addBend(connections_.ball(primitive)) ? Anchor::Since::InBall : Anchor::Since::Unconnectable;
  } else {
    anchor.since = Anchor::Since::Unconnectable;
  }
}

/// How much of a light that scattering has met counts, the rest being the connections' share.
double PathTracer::meetingWeight(const Walk& walk, LightId light, const Vec3& normal, const Vec3& point,
                                 double distance) const {
  const Anchor& anchor = walk.anchor;
  if (anchor.since != Anchor::Since::Connectable) return 1.0;
  const int connection = connections_.find(light, anchor.chain);
  if (connection < 0) return 1.0;
  const LightMeeting meeting{anchor.position, walk.direction, distance, normal, anchor.bendPoint, point};
  const double tries = anchor.connections * table_.chance(anchor.position, anchor.normal, connection);
  return powerHeuristic(anchor.pdf, tries * connections_.pdf(connection, meeting));
}

RgbSum PathTracer::lightAtInfinity(const Walk& walk) const {
  RgbSum sum(0);
  for (LightId light : scene_.lights().atInfinity()) {
    const Rgb L = scene_.lights().radianceFrom(light, walk.direction);
    if (isBlack(L)) continue;
    sum += walk.throughput * L * static_cast<float>(meetingWeight(walk, light, Vec3(0), Vec3(0), kInfinity));
  }
  if (walk.anchor.since == Anchor::Since::Camera)
    for (const DomeLight& dome : scene_.scene().backdrops) sum += walk.throughput * skyRadiance(dome, walk.direction);
  return sum;
}

Rgb PathTracer::lightOf(const Walk& walk, PrimitiveId primitive, const tracing::Hit& hit) const {
  const LightId light = scene_.lights().lightOf(primitive);
  if (!light.valid()) {
    if (walk.anchor.since != Anchor::Since::Camera) return Rgb(0.0f);
    return scene::seenRadiance(scene_.scene().materialOf(primitive), -walk.direction, walk.anchor.fromSurface,
                               hit.front);
  }
  const Rgb L = scene_.lights().emittedRadiance(light, -walk.direction, walk.anchor.fromSurface, hit.front);
  if (isBlack(L)) return L;
  return L * static_cast<float>(meetingWeight(walk, light, Vec3(hit.normal), Vec3(hit.position), walk.anchor.distance));
}

}  // namespace deltalux::rendering
