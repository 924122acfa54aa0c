#include "particles/bounce.hpp"

#include <algorithm>

#include "base/tuning.hpp"

namespace deltalux::particles {

namespace {

bool takesParticles(const Material& m, bool front) {
  return !isClear(m) && !(front && std::holds_alternative<Mirror>(m.surface));
}

}  // namespace

EventSequence::EventSequence(std::uint64_t key, int depth)
    : own_(combineKeys(key, 16 + static_cast<std::uint64_t>(depth))),
      stratified_(depth < deltalux::tuning::kPilotBounces),
      first_(own_),
      second_(~own_) {}

EventNumbers EventSequence::operator()(std::uint32_t index) const {
  if (stratified_) {
    const UnitPair a = first_(index), b = second_(index);
    return {{a.x, b.x, b.y}, a.y};
  }
  Rng rng(own_, index);
  EventNumbers u;
  for (int i = 0; i < 3; ++i) u.scatter[i] = rng.uniform();
  u.roulette = rng.uniform();
  return u;
}

ParticleSurfaces::ParticleSurfaces(const Scene& scene) : scene_(scene) {
  for (const Material& m : scene.materials) {
    for (const bool front : {false, true}) {
      Side s;
      s.bsdf = scene::specularPart(scene::makeBsdf(m, front));
      s.first = scene::withoutPassage(s.bsdf);
      s.takes = takesParticles(m, front);
      s.rough = s.bsdf.hasFinitePart();
      s.passesOn = s.rough || passesStraight(m) || s.bsdf.refractingIor || !isBlack(s.bsdf.reflection.reflectance) ||
                   !isBlack(s.bsdf.transmission.reflectance);
      sides_.push_back(s);
    }
    bodies_.push_back(std::get_if<Dielectric>(&m.surface));
    panes_.push_back(isPane(m));
  }
}

std::optional<SpecularEvent> ParticleSurfaces::scatter(const SurfaceSpot& at, const Vec3f& direction, bool first,
                                                       const EventNumbers& u) const {
  const Side& s = side(at.primitive, at.front);
  if (!s.passesOn) return std::nullopt;
  const Frame frame(glm::normalize(at.front ? Vec3(at.normal) : -Vec3(at.normal)));
  const Vec3 wo = frame.toLocal(-Vec3(direction));
  if (!(wo.z > 0)) return std::nullopt;
  SpecularEvent event;
  if (first && s.bsdf.pane) {
    event.weight = scene::mirrorReflectance(s.first, wo.z);
    event.direction = Vec3f(glm::normalize(frame.toWorld({-wo.x, -wo.y, wo.z})));
    return event;
  }
  const auto sampled = scene::sample(first ? s.first : s.bsdf, wo, u.scatter);
  if (!sampled) return std::nullopt;
  event.weight = sampled->weight;
  event.direction = Vec3f(glm::normalize(frame.toWorld(sampled->direction)));
  event.refracted = sampled->event == scene::ScatterEvent::Refraction;
  return event;
}

glm::vec2 ParticleSurfaces::parameters(const tracing::Hit& hit) const {
  const Shape& shape = scene_[hit.primitive].shape;
  const Vec3 p(hit.position);
  if (const auto* polygon = std::get_if<Polygon>(&shape)) {
    const Vec3 d = p - polygon->origin;
    return {glm::dot(d, polygon->dualU), glm::dot(d, polygon->dualV)};
  }
  if (const auto* mesh = std::get_if<Mesh>(&shape)) {
    const auto& t = mesh->triangles[hit.triangle];
    const Vec3 p0 = mesh->positions[t[0]], a = mesh->positions[t[1]] - p0, b = mesh->positions[t[2]] - p0;
    const Vec3 n = glm::cross(a, b);
    const double squared = glm::dot(n, n);
    return {glm::dot(glm::cross(p - p0, b), n) / squared, glm::dot(glm::cross(a, p - p0), n) / squared};
  }
  return glm::vec2(parameterAt(shape, p));
}

}  // namespace deltalux::particles
