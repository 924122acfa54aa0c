#include "glare/luminaires.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/disjoint_sets.hpp"
#include "base/sobol.hpp"
#include "glare/sight_frame.hpp"
#include "tracing/shadow_ray.hpp"

namespace deltalux::glare {

namespace {

constexpr std::uint32_t kFewRays = 256, kManyRays = 4096;  // solid angles of half-hidden lamps are off by 0.5 % [limit]
constexpr double kGrazing = 0.05;                          // least cosine that a middle is weighted by [rounding]
constexpr double kSmallArea = 0.005;                       // [m2] [CIE 147] [defined]
constexpr double kTouching = 1e-3;                         // [m] [defined]
constexpr std::uint64_t kLampKey = 0x61a3e;                // [key]

/// The object that a light's lamp is a part of: the parent of its own, or that itself where there is none.
ObjectId lampObject(const Scene& scene, const AreaLight& light) {
  const ObjectId own = scene[light.primitive].object;
  return own.valid() && scene[own].parent.valid() ? scene[own].parent : own;
}

bool touch(const Box& a, const Box& b, double within) {
  return a.overlaps({b.lower - Vec3(within), b.upper + Vec3(within)});
}

/// Area of a luminaire's opening across direction `w` (local, from the luminaire) [m2]: a box, or where its sides are
/// negative a drum, of which the bottom and the sides shine.
double openingAcross(const Vec3& opening, const Vec3& w) {
  double across = std::abs(opening.x), along = std::abs(opening.y);  // over the 90 plane, over the 0 plane
  const bool round = opening.x < 0 || opening.y < 0;
  if (round && across == 0) across = along;
  if (round && along == 0) along = across;
  const double side = std::hypot(w.x, w.y), height = opening.z;
  if (round) {
    const double wide = side > 0 ? std::hypot(along * w.y, across * w.x) / side : 0;
    return kPi / 4 * across * along * std::abs(w.z) + height * wide * side;
  }
  return across * along * std::abs(w.z) + height * (along * std::abs(w.y) + across * std::abs(w.x));
}

}  // namespace

SeenLight& SeenLight::operator+=(const SeenLight& o) {
  solidAngle += o.solidAngle, normalLux += o.normalLux, illuminance += o.illuminance, area += o.area;
  middle += o.middle;
  return *this;
}

SeenLight& SeenLight::operator/=(double n) {
  solidAngle /= n, normalLux /= n, illuminance /= n, area /= n, middle /= n;
  return *this;
}

std::vector<LuminaireLights> luminairesOf(const Scene& scene) {
  std::vector<LightId> lights;
  std::map<ObjectId, std::vector<std::uint32_t>> ofObject;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const auto& emitter = scene.lights[i].emitter;
    if (std::holds_alternative<SunLight>(emitter) || std::holds_alternative<DomeLight>(emitter)) continue;
    if (const auto* area = std::get_if<AreaLight>(&emitter))
      if (const ObjectId object = lampObject(scene, *area); object.valid())
        ofObject[object].push_back(static_cast<std::uint32_t>(lights.size()));
    lights.emplace_back(i);
  }
  DisjointSets sets(lights.size());
  const auto box = [&](std::uint32_t i) {
    return bounds(scene[std::get<AreaLight>(scene[lights[i]].emitter).primitive].shape);
  };
  for (const auto& [object, parts] : ofObject)
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (std::size_t j = i + 1; j < parts.size(); ++j)
        if (touch(box(parts[i]), box(parts[j]), kTouching / scene.metresPerUnit)) sets.join(parts[i], parts[j]);
  std::vector<LuminaireLights> all;
  std::vector<std::size_t> at(lights.size());
  for (std::uint32_t i = 0; i < lights.size(); ++i) {
    if (sets.of(i) == i) at[i] = all.size(), all.push_back({scene[lights[i]].name, {}});
    all[at[sets.of(i)]].lights.push_back(lights[i]);
  }
  return all;
}

LuminaireMeter::LuminaireMeter(const Scene& scene, const tracing::RayTracer& tracer)
    : scene_(scene), tracer_(tracer), sampler_(scene), luminaires_(luminairesOf(scene)) {}

SeenLight LuminaireMeter::seenArea(LightId id, const Eye& eye, const Vec3& ahead) const {
  SeenLight seen;
  const ScrambledSobol points(combineKeys(kLampKey, id.value));
  std::uint32_t rays = 0, hidden = 0;
  // As many as do where all of it is seen, or none; more where it is seen in part.
  while (rays < kFewRays || (rays < kManyRays && hidden > 0 && hidden < rays)) {
    const UnitPair u = points(rays++);
    const auto s = sampler_.sample(id, eye.position, {u.x, u.y});
    const double cosine = s ? glm::dot(s->direction, ahead) : 0;
    if (!s || !(s->pdf > 0) || !(cosine > 0)) {
      ++hidden;
      continue;
    }
    const Rgb V =
        tracer_.transmittance(tracing::shadowRay(eye.position, Vec3(0), s->direction, s->distance, s->normal));
    if (isBlack(V)) {
      ++hidden;
      continue;
    }
    const double omega = 1 / s->pdf, metres = std::isinf(s->distance) ? 1 : s->distance * scene_.metresPerUnit;
    const double E = omega * photometric(glm::dvec3(V * s->radiance), scene_.luminousEfficacy);
    // L dA: of the luminous area, not of the solid angle, is the middle wanted.
    const double tilt =
        glm::length(s->normal) > 0 ? std::max(kGrazing, std::abs(glm::dot(s->normal, s->direction))) : 1;
    seen += {omega, E, E * cosine, omega * metres * metres, E * metres * metres / tilt * metres * s->direction};
  }
  seen /= rays;
  return seen;
}

SeenLight LuminaireMeter::seenPoint(LightId id, const Eye& eye, const Vec3& ahead) const {
  const auto s = sampler_.sample(id, eye.position, {0.5, 0.5});
  if (!s || !(glm::dot(s->direction, ahead) > 0)) return {};
  Vec3 opening(0), u(0), v(0);
  double area = 0;
  if (const auto* measured = std::get_if<PhotometricLight>(&scene_[id].emitter)) {
    opening = measured->photometry->opening;
    area = openingAcross(opening, glm::transpose(measured->frame) * -s->direction);
    u = std::abs(opening.y) / scene_.metresPerUnit * measured->frame[0];
    v = std::abs(opening.x) / scene_.metresPerUnit * measured->frame[1];
  }
  // How much of it is seen: by rays to the opening, which lies where the light is.
  const Vec3 middle = sampler_.position(id);
  const bool extended = glm::length(u) + glm::length(v) > 0;
  const std::uint32_t rays = extended ? kFewRays : 1;
  const ScrambledSobol points(combineKeys(kLampKey, id.value));
  Rgb V(0.0f);
  double open = 0;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const UnitPair at = points(i);
    const Vec3 d = (extended ? middle + (at.x - 0.5) * u + (at.y - 0.5) * v : middle) - eye.position;
    const double distance = glm::length(d);
    const Rgb passed =
        tracer_.transmittance(tracing::shadowRay(eye.position, Vec3(0), d / distance, distance, Vec3(0)));
    V += passed / static_cast<float>(rays);
    open += isBlack(passed) ? 0.0 : 1.0 / rays;
  }
  const double metres = s->distance * scene_.metresPerUnit;
  const double E = photometric(glm::dvec3(V * s->radiance), scene_.luminousEfficacy);
  return {open * area / (metres * metres), E, E * glm::dot(s->direction, ahead), open * area,
          E * metres * metres * metres * s->direction};
}

SeenLight LuminaireMeter::seen(LightId id, const Eye& eye, const Vec3& ahead) const {
  return sampler_.isPointLike(id) ? seenPoint(id, eye, ahead) : seenArea(id, eye, ahead);
}

std::vector<LuminaireSeen> LuminaireMeter::seen(const Eye& eye) const {
  const Vec3 ahead = SightFrame(eye).ahead;
  std::vector<LuminaireSeen> all;
  for (const LuminaireLights& luminaire : luminaires_) {
    SeenLight sum;
    for (const LightId id : luminaire.lights) sum += seen(id, eye, ahead);
    if (!(sum.normalLux > 0)) continue;
    LuminaireSeen l{luminaire.name, luminaire.lights, {}, sum.illuminance, sum.area < kSmallArea};
    l.source.direction = glm::normalize(sum.middle);
    if (l.small) {
      // [CIE 147]: L^2 omega becomes (I / 0.005)^2 0.005 / d^2, 200 I^2 / d^2.
      const double d2 = sum.area > 0 ? sum.area / sum.solidAngle : distanceSquared(luminaire.lights.front(), eye);
      sum.solidAngle = kSmallArea / d2;
    }
    l.source.solidAngle = sum.solidAngle, l.source.luminance = sum.normalLux / sum.solidAngle;
    l.source.positionIndex = positionIndex(eye, l.source.direction);
    all.push_back(std::move(l));
  }
  std::ranges::stable_sort(all, std::greater(), [](const LuminaireSeen& l) { return disturbance(l.source); });
  return all;
}

double LuminaireMeter::distanceSquared(LightId point, const Eye& eye) const {
  const Vec3 d = scene_.metresPerUnit * (sampler_.position(point) - eye.position);
  return glm::dot(d, d);
}

std::vector<GlareSource> LuminaireMeter::suns(const Eye& eye) const {
  const Vec3 ahead = SightFrame(eye).ahead;
  std::vector<GlareSource> all;
  for (const LightId id : sampler_.atInfinity()) {
    if (!std::holds_alternative<SunLight>(scene_[id].emitter)) continue;
    const SeenLight disc = seenArea(id, eye, ahead);
    if (!(disc.normalLux > 0)) continue;
    GlareSource s{glm::normalize(disc.middle), disc.normalLux / disc.solidAngle, disc.solidAngle, 1};
    s.positionIndex = positionIndex(eye, s.direction);
    all.push_back(s);
  }
  return all;
}

}  // namespace deltalux::glare
