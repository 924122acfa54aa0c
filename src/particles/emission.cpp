#include "particles/emission.hpp"
#include "base/square.hpp"
#include "base/tuning.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::particles {

namespace {

constexpr double kVeryFar = 1e100;  // where a spotlight's focal offset no longer matters [sentinel]

}  // namespace

double farDistance(const Scene& scene) { return 4 * coarse(std::max(bounds(scene).diagonal(), 1e-6)); }

ParticleEmission::ParticleEmission(const Scene& scene, const tracing::RayTracer& tracer, const Senders& senders,
                                   const Receivers& receivers)
    : scene_(scene), tracer_(tracer), senders_(senders), receivers_(receivers), aiming_(scene, receivers) {
  far_ = farDistance(scene);
}

const Emission& ParticleEmission::emission(const SenderCell& c) const {
  return *scene_.materialOf(c.primitive).emission;
}

void ParticleEmission::sample(const LinkEnds& link, const EmissionNumbers& u, FirstSegment& s) const {
  s = {};
  const Senders::Choice chosen = choose(link, u.choice.x);
  const double share = 1 / chosen.chance;
  s.senderCell = chosen.cell;
  // What was removed keeps its place among cells.
  if (!(senders_.cells()[s.senderCell].measure > 0)) return;
  const SenderKind kind = senders_.cells()[s.senderCell].kind;
  if (kind == SenderKind::Sun || kind == SenderKind::Sky)
    fromInfinity(link, u, share, s);
  else
    fromPlace(link, u, share, s);
}

/// A cluster close to its receivers holds few cells that are much closer than the others: those are to be drawn.
Senders::Choice ParticleEmission::choose(const LinkEnds& link, double u) const {
  const RadixNode& node = senders_.nodes()[link.sender];
  if (node.isLeaf()) return {node.begin, 1};
  const SenderKind kind = senders_.cells()[node.begin].kind;
  if (kind != SenderKind::Side && kind != SenderKind::Lamp) return senders_.choose(link.sender, u);
  const BoundingSphere& ball = receivers_.bound(link.receiver);
  return ball.empty() ? senders_.choose(link.sender, u) : senders_.chooseNear(link.sender, ball, u);
}

void ParticleEmission::fromInfinity(const LinkEnds& link, const EmissionNumbers& u, double share,
                                    FirstSegment& s) const {
  const SenderCell& c = senders_.cells()[s.senderCell];
  const Vec3 w = senders_.direction(s.senderCell, u.origin);
  Rgb L;
  if (const auto* sun = std::get_if<SunLight>(&scene_[c.light].emitter))
    L = sun->radiance;
  else
    L = skyRadiance(std::get<DomeLight>(scene_[c.light].emitter), w);
  const RadixNode& node = receivers_.nodes()[link.receiver];
  const std::uint32_t cell = receivers_.choose(node, u.choice.y);
  const double area = receivers_.area(cell) * receivers_.weightOf(node) / receivers_.weight(cell);
  s.receiverCell = cell;
  if (!(area > 0)) return;
  s.atInfinity = true;
  ReceiverPoint x;
  if (receivers_.isFlat(cell)) {
    const auto point = receivers_.flatPoint(cell, receivers_.rectangle(cell).at(u.direction));
    s.bound = deltalux::tuning::kDefensive * static_cast<float>(share * c.measure * area) * gray(L);
    if (!point) return;
    x = *point;
  } else {
    x = receivers_.curvedPoint(cell, u.direction);
  }
  const double weight = share * c.measure * area, cosine = std::abs(glm::dot(x.normal, w));
  s.flux = static_cast<float>(weight * cosine) * L;
  s.bound = std::max(gray(s.flux), deltalux::tuning::kDefensive * static_cast<float>(weight) * gray(L));
  if (isBlack(s.flux) || aiming_.hidesItself(cell, x.position, w, nullptr)) return;
  s.kind = FirstSegment::Kind::Target;
  s.target = x.position, s.normal = x.normal;
  s.direction = -Vec3f(w);
  s.origin = Vec3f(x.position + far_ * w);
  s.ray.direction = Vec3f(w);
  s.ray.origin = tracing::offsetOrigin(Vec3f(x.position), Vec3f(x.normal), s.ray.direction);
}

void ParticleEmission::fromPlace(const LinkEnds& link, const EmissionNumbers& u, double share, FirstSegment& s) const {
  const SenderCell& c = senders_.cells()[s.senderCell];
  SendingPoint y;
  if (c.kind == SenderKind::Point) {
    y.position = senders_.bound(link.sender).center;
  } else {
    const SurfacePoint p = senders_.point(s.senderCell, u.origin);
    y.position = p.position, y.normal = p.normal, y.lambertian = true;
    s.originTriangle = p.triangle;
    if (const auto omega = aiming_.behind(y, link.receiver)) {
      const float whole = c.kind == SenderKind::Side ? static_cast<float>(1 / kPi) : gray(emission(c).radiance);
      s.bound = deltalux::tuning::kDefensive * static_cast<float>(share * c.measure * *omega) * whole;
      return;
    }
  }
  Aim a;
  aiming_.aim(y, link.receiver, u.choice.y, u.direction, a);
  s.receiverCell = a.cell;
  if (!(a.density > 0)) return;
  const double weight = share * c.measure / a.density;
  const double cosine = y.lambertian ? glm::dot(a.direction, y.normal) : 1.0;
  Rgb whole(1.0f), shape(1.0f);  // of the sender at its brightest, and towards here
  if (c.kind == SenderKind::Side) {
    whole = Rgb(static_cast<float>(1 / kPi));
    shape = cosine > 0 ? whole : Rgb(0.0f);
  } else if (c.kind == SenderKind::Lamp) {
    whole = emission(c).radiance;
    // The length of open segments is not known yet; arrive() puts it in.
    const double distance = a.kind == FirstSegment::Kind::Target ? a.distance : kVeryFar;
    if (cosine > 0) {
      shape = scene::emittedRadiance(emission(c), a.direction, distance, c.front);
    } else {
      shape = Rgb(0.0f);
    }
  } else {
    std::visit(
        [&](const auto& e) {
          if constexpr (requires { radiantIntensity(e, a.direction); })
            shape = whole = radiantIntensity(e, a.direction);
        },
        scene_[c.light].emitter);
  }
  s.flux = static_cast<float>(weight * std::max(cosine, 0.0)) * shape;
  s.bound = std::max(gray(s.flux), deltalux::tuning::kDefensive * static_cast<float>(weight) * gray(whole));
  if (isBlack(s.flux) || a.kind == FirstSegment::Kind::None) return;
  s.kind = a.kind;
  s.direction = Vec3f(a.direction), s.origin = Vec3f(y.position);
  s.balance = static_cast<float>(a.balance);
  s.density = static_cast<float>(a.kind == FirstSegment::Kind::Open ? 2 * a.density : a.density);
  if (a.kind == FirstSegment::Kind::Target) {
    s.target = a.target, s.normal = a.normal;
    s.ray = tracing::segment(s.origin, Vec3f(y.normal), Vec3f(a.target), Vec3f(a.normal));
  } else {
    s.ray.direction = s.direction;
    s.ray.origin = tracing::offsetOrigin(s.origin, Vec3f(y.normal), s.direction);
  }
}

void ParticleEmission::arrive(std::span<const LinkEnds> links, std::span<const FirstSegment> segments,
                              std::span<FirstHit> arrivals, FirstRays& w, std::uint64_t& rays) const {
  auto& [targets, opens, straight, open, passed, hits] = w;
  targets.clear(), opens.clear(), straight.clear(), open.clear();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const FirstSegment& s = segments[i];
    arrivals[i] = {};
    if (s.kind == FirstSegment::Kind::Target)
      targets.push_back(static_cast<std::uint32_t>(i)), straight.push_back(s.ray);
    if (s.kind == FirstSegment::Kind::Open) opens.push_back(static_cast<std::uint32_t>(i)), open.push_back(s.ray);
  }
  passed.resize(straight.size());
  tracer_.passings(straight, passed);
  hits.resize(open.size());
  tracer_.closestHits(open, hits);
  rays += straight.size() + open.size();
  for (std::size_t k = 0; k < targets.size(); ++k) {
    const Rgb& share = passed[k].share;
    const FirstSegment& s = segments[targets[k]];
    FirstHit& a = arrivals[targets[k]];
    a.blocker = passed[k].blocker;
    if (isBlack(share)) continue;
    a.primitive = receivers_.primitive(s.receiverCell);
    a.triangle = receivers_.triangle(s.receiverCell);
    a.position = Vec3f(s.target), a.normal = Vec3f(s.normal), a.direction = s.direction;
    a.distance = s.atInfinity ? std::numeric_limits<float>::infinity() : glm::length(a.position - s.origin);
    // An open direction would have ended at the first pane.
    const bool byEither = share == Rgb(1.0f);
    a.flux = s.flux * share * (byEither ? s.balance : 1.0f);
  }
  for (std::size_t k = 0; k < opens.size(); ++k)
    if (hits[k]) meet(links[opens[k]], segments[opens[k]], hits[k], arrivals[opens[k]]);
}

void ParticleEmission::meet(const LinkEnds& link, const FirstSegment& s, const tracing::Hit& hit, FirstHit& a) const {
  const RadixNode& node = receivers_.nodes()[link.receiver];
  const std::uint32_t cell = receivers_.cellOf(hit);
  if (cell < node.begin || cell >= node.end) {
    a.blocker = hit.primitive;
    a.position = hit.position, a.distance = hit.t;
    return;
  }
  a.primitive = hit.primitive, a.triangle = hit.triangle;
  a.position = hit.position, a.normal = hit.normal, a.direction = s.direction;
  a.distance = hit.t, a.flux = s.flux;
  const double other =
      aiming_.densityAtCell(Vec3(s.origin), node, cell, Vec3(hit.position), glm::normalize(Vec3(hit.normal)));
  a.flux *= static_cast<float>(s.density / (s.density + other));  // [Veach97 9.8]
  const SenderCell& c = senders_.cells()[s.senderCell];
  if (c.kind == SenderKind::Lamp && emission(c).spot) {
    const double focal = glm::length(emission(c).spot->direction);
    a.flux *= static_cast<float>(square(a.distance / (a.distance + focal)));
  }
}

bool ParticleEmission::averted(const LinkEnds& link) const {
  const Senders::Cone& cone = senders_.normals(link.sender);
  const RadixNode& node = senders_.nodes()[link.sender];
  const SenderCell &first = senders_.cells()[node.begin], &last = senders_.cells()[node.end - 1];
  if (cone.cosine < 1 || first.primitive != last.primitive || first.front != last.front) return false;
  const BoundingSphere& ball = receivers_.bound(link.receiver);
  return glm::dot(cone.axis, ball.center - senders_.point(node.begin, {0.5, 0.5}).position) + ball.radius <= 0;
}

}  // namespace deltalux::particles
