// Sampling of connections and its density: the ways are put together from their corners, near end first.
#include <algorithm>
#include <cmath>

#include "render/reference/bent_way.hpp"
#include "render/reference/curved_bend.hpp"

namespace deltalux::rendering {

namespace {

double reciprocal(double pdf) { return pdf > 0.0 ? 1.0 / pdf : 1.0; }

}  // namespace

Arrivals LightConnections::sample(int connection, const Vec3& x, const Vec3& n, const Vec2& u) const {
  return sample(list_[connection], x, n, u);
}

Arrivals LightConnections::sample(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u) const {
  Arrivals arrivals;
  if (c.chain.curved() < 0) {
    samplePlanes(c, x, n, u, arrivals);
  } else {
    sampleCurved(c, x, n, u, arrivals);
  }
  return arrivals;
}

void LightConnections::samplePlanes(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u,
                                    Arrivals& out) const {
  const Scene& scene = scene_.scene();
  std::array<Vec3, 3> images{x};
  for (int i = 0; i < c.chain.count; ++i)
    images[i + 1] = planeOf(scene[c.chain.bends[i].surface].shape)->image(images[i]);
  const auto s = scene_.lights().sample(c.light, images[c.chain.count], u);
  if (!s) return;
  // Back from the light: where the line from the last image meets the last plane, from there to the image before, ...
  std::array<Vec3, 2> corners;
  std::array<double, 2> slopes;
  Vec3 direction = s->direction;
  double reach = s->distance;
  for (int i = c.chain.count - 1; i >= 0; --i) {
    const Shape& shape = scene[c.chain.bends[i].surface].shape;
    const Plane plane = *planeOf(shape);
    slopes[i] = glm::dot(direction, plane.normal);
    const double t = plane.height(images[i]) / slopes[i];  // images[i] is as far before the plane as its image behind
    if (!(t > 0.0) || !(t < reach)) return;
    corners[i] = images[i + 1] + t * direction;
    if (!contains(shape, corners[i])) return;
    direction = plane.reflected(direction), reach = t;
  }
  BentWay way(scene_, x, n);
  for (int i = 0; i < c.chain.count; ++i) {
    if (!way.mirrorAt(c.chain.bends[i].surface, corners[i], slopes[i])) return;
  }
  Rgb L = s->radiance;
  double rest = s->distance;
  if (c.chain.count > 0) {
    rest -= glm::length(corners[c.chain.count - 1] - images[c.chain.count]);
    // The spotlight rule counts the distance to the first surface, which is the last mirror.
    if (scene_.lights().area(c.light) > 0.0) L = scene_.lights().emittedRadiance(c.light, -s->direction, rest, true);
  }
  way.lastLeg(s->direction, rest, s->normal);
  Arrival& a = out.list[out.count++];
  way.finish(a);
  a.value = L * way.attenuation() * static_cast<float>(reciprocal(s->pdf));
  a.pdf = s->pdf;
}

LightConnections::LightEnd LightConnections::sampleEnd(LightId light, const Vec2& u) const {
  const scene::LightSampler& lights = scene_.lights();
  if (const auto* sun = std::get_if<SunLight>(&scene_.scene()[light].emitter)) {
    return {{lights.sample(light, Vec3(0), u)->direction, true}, Vec3(0), 1.0 / solidAngle(*sun)};
  }
  if (lights.isPointLike(light)) return {{lights.position(light), false}, Vec3(0), 0.0};
  const SurfacePoint p = lights.samplePoint(light, u);
  return {{p.position, false}, p.normal, 1.0 / lights.area(light)};
}

/// The light that an end sends back against `onward` over `distance`, where a beam has spread so far: sets value and
/// pdf.
bool LightConnections::shine(Arrival& a, LightId light, LightEnd& end, const Vec3& onward, double distance,
                             double spread) const {
  const scene::LightSampler& lights = scene_.lights();
  if (!(spread > 0.0)) return false;
  if (end.place.infinite) {
    a.value = lights.radianceFrom(light, end.place.at);
    a.pdf = end.density * spread;
  } else if (end.density > 0.0) {
    const double cosine = -glm::dot(onward, end.normal);
    if (cosine == 0.0) return false;
    a.value = lights.emittedRadiance(light, -onward, distance, cosine > 0.0);
    a.pdf = end.density * spread / std::abs(cosine);
    if (cosine < 0.0) end.normal = -end.normal;
  } else {
    a.value = lights.intensity(light, -onward) * static_cast<float>(1.0 / spread);
  }
  a.value *= static_cast<float>(reciprocal(a.pdf));
  return !isBlack(a.value);
}

void LightConnections::sampleCurved(const Connection& c, const Vec3& x, const Vec3& n, const Vec2& u,
                                    Arrivals& out) const {
  const int middle = c.chain.curved();
  const Bend *before = middle > 0 ? &c.chain.bends[0] : nullptr,
             *behind = middle + 1 < c.chain.count ? &c.chain.bends[1] : nullptr;
  const LightEnd end = sampleEnd(c.light, u);
  const Vec3 from = before ? plane(*before).image(x) : x;
  const Turns turns = findTurns(scene_, c.chain.bends[middle], from, behind ? mirrored(end.place, *behind) : end.place);
  for (int i = 0; i < turns.count; ++i) {
    const Turn& turn = turns.list[i];
    BentWay way(scene_, x, n);
    way.attenuate(turn.passed);
    double t = 0;
    const double reach = glm::length(turn.in - from);
    if (before && !way.mirrorOn(before->surface, from, (turn.in - from) / reach, reach, t)) continue;
    way.leg(turn.in, turn.inNormal);
    const auto& shape = scene_.scene()[c.chain.bends[middle].surface].shape;
    for (int k = 0; k < turn.innerCount; ++k)
      way.leg(turn.inner[k], glm::normalize(turn.inner[k] - std::get<Sphere>(shape).center));
    if (c.chain.bends[middle].kind == Bend::Kind::Ball) way.leg(turn.out, turn.outNormal);
    Vec3 onward = turn.onward;
    double rest = turn.after;
    if (behind) {
      if (!way.mirrorOn(behind->surface, turn.out, onward, rest, t)) continue;
      onward = plane(*behind).reflected(onward), rest -= t;
    }
    Arrival a;
    LightEnd shining = end;
    if (!shine(a, c.light, shining, onward, rest, turn.spread)) continue;
    way.lastLeg(onward, rest, shining.normal);
    way.finish(a);
    a.value *= way.attenuation();
    if (!isBlack(a.value)) out.list[out.count++] = a;
  }
}

Plane LightConnections::plane(const Bend& bend) const { return *planeOf(scene_.scene()[bend.surface].shape); }

LightPlace LightConnections::mirrored(const LightPlace& place, const Bend& flat) const {
  return {place.infinite ? plane(flat).reflected(place.at) : plane(flat).image(place.at), place.infinite};
}

double LightConnections::pdf(int connection, const LightMeeting& m) const {
  const Connection& c = list_[connection];
  const int middle = c.chain.curved();
  Vec3 from = m.from;
  for (int i = 0; i < (middle < 0 ? c.chain.count : middle); ++i) from = plane(c.chain.bends[i]).image(from);
  if (middle < 0) return scene_.lights().pdf(c.light, from, m.direction, m.distance, m.normal);

  const auto* sun = std::get_if<SunLight>(&scene_.scene()[c.light].emitter);
  LightPlace place{sun ? m.direction : m.lightPoint, sun != nullptr};
  if (middle + 1 < c.chain.count) place = mirrored(place, c.chain.bends[1]);
  // Solve again from both ends: only what the solver finds can have been connected.
  const double near = 1e-3 * glm::length(m.bendPoint - from) + 1e-5;
  double spread = 0;
  const Turns turns = findTurns(scene_, c.chain.bends[middle], from, place);
  for (int i = 0; i < turns.count; ++i) {
    if (glm::length(turns.list[i].in - m.bendPoint) <= near) spread = turns.list[i].spread;
  }
  if (sun) return spread / solidAngle(*sun);
  const double cosine = std::abs(glm::dot(m.direction, m.normal));
  return cosine > 0.0 ? spread / (scene_.lights().area(c.light) * cosine) : 0.0;
}

}  // namespace deltalux::rendering
