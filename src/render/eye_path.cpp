#include "render/eye_path.hpp"

#include <algorithm>

#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "render/caustic_light.hpp"
#include "scene/texture_tint.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

namespace {
constexpr std::uint64_t kShadowKey = 1 << 8, kOtherSideKey = 1 << 9, kScatterKey = 1 << 10;  // [key]

/// Whether a surface without its diffuse part sends light more than one way.
bool isLeftToChance(const scene::Bsdf& specular) {
  const int ways = !isBlack(specular.reflection.reflectance) + !isBlack(specular.transmission.reflectance) +
                   !isBlack(specular.passage);
  return specular.hasFinitePart() || specular.pane || specular.refractingIor || ways > 1;
}
}  // namespace

struct EyePaths::Vertex {
  tracing::Hit hit;
  Vec3 position, direction;  // of the ray that came
  Vec3 normal;               // unit, on the side that the ray came from

  Vec3 sideNormal(bool front) const { return front == hit.front ? normal : -normal; }
};

EyePaths::EyePaths(const Solution& s, const Reconstruction& reconstruction, EyeSettings settings)
    : scene_(s.scene),
      elements_(s.elements),
      caustics_(s.caustics),
      tracer_(*s.tracer),
      reconstruction_(reconstruction),
      settings_(settings),
      panesReflect_(!s.settings.diffuseOnly) {
  for (const Material& m : scene_.materials) {
    goesOn_.push_back(isSpecular(m) || passesStraight(m));
    for (const bool front : {false, true}) bsdfs_.push_back(scene::makeBsdf(m, front));
  }
}

Rgb EyePaths::radiance(const EyeRay& eye, Sights& sights) const { return follow({eye.ray}, eye, sights); }

Rgb EyePaths::diffuse(const tracing::Hit& hit) const {
  const Vec3 position(hit.position);
  const scene::Bsdf& b = bsdf(hit.primitive, hit.front);
  const auto from = [&](bool front) {
    const hierarchy::ElementId side = reconstruction_.locator.side(hit.primitive, hit.triangle, front);
    if (!side.valid()) return Rgb(0.0f);
    const hierarchy::LeafPoint at = reconstruction_.locator.locate(side, position);
    Rgb E = elements_.radiometry[at.leaf.index()].direct + reconstruction_.field.indirect(at, Vec3f(position));
    if (const auto caustic = causticLight(caustics_, scene_, hit.primitive, hit.triangle, front, position))
      E += *caustic;
    return E;
  };
  Rgb sum(0.0f);
  if (!isBlack(b.diffuseReflection)) sum += b.diffuseReflection * from(hit.front);
  if (!isBlack(b.diffuseTransmission)) sum += b.diffuseTransmission * from(!hit.front);
  return float(1 / kPi) * scene::textureTint(scene_, hit.primitive, hit.triangle, position) * sum;
}

Rgb EyePaths::follow(Way w, const EyeRay& eye, Sights& sights) const {
  Rgb L(0.0f);
  while (w.depth <= settings_.maxDepth) {
    const tracing::Hit hit = tracer_.closestHit(w.ray);
    if (eye.trail) w.corner = eye.trail->add(w.ray, hit, w.corner);
    if (!hit) return L + w.beta * background(w);
    const Vec3 n = hit.front ? Vec3(hit.normal) : -Vec3(hit.normal);
    const Vertex v{hit, Vec3(hit.position), Vec3(w.ray.direction), n};
    L += w.beta * emitted(w, v);
    const scene::Bsdf& scattering = bsdf(hit.primitive, hit.front);
    if (scattering.pane && !panesReflect_) {
      w.beta *= scene::passageTransmittance(scattering, -glm::dot(v.direction, n));
      w.ray.origin = tracing::offsetOrigin(Vec3f(v.position), hit.normal, w.ray.direction);
      if (maxChannel(w.beta) < deltalux::tuning::kNegligible) return L;
      continue;
    }
    bool lightsMet = false;
    L += w.beta * scattered(v, eye, w.depth, sights, lightsMet);
    if (!goesOn_[scene_[hit.primitive].material.index()]) return L;

    if (const auto* body = std::get_if<Dielectric>(&scene_.materialOf(hit.primitive).surface); body && !hit.front)
      w.beta *= glm::pow(body->transmission, Rgb(hit.t));
    if (!goOn(w, v, scattering, eye, lightsMet, [&](Way other) { L += follow(other, eye, sights); })) return L;
  }
  return L;
}

bool EyePaths::go(Way& w, const Vertex& v, const scene::Bsdf& scattering, const scene::BsdfSample& s,
                  bool lightsMet) const {
  w.beta *= s.weight / static_cast<float>(s.etaSquared);
  const SpecularLobe& shape = s.direction.z > 0 ? scattering.reflection : scattering.transmission;
  const bool glossy = !scene::isDirac(s.event);
  w.lobe = glossy && lightsMet ? std::optional(Lobe{v.position, shape.roughness}) : std::nullopt;
  w.clear = w.clear && !glossy;
  w.ray.direction = Vec3f(glm::normalize(Frame(v.normal).toWorld(s.direction)));
  w.ray.origin = tracing::offsetOrigin(Vec3f(v.position), v.hit.normal, w.ray.direction);
  ++w.depth;
  return maxChannel(w.beta) >= deltalux::tuning::kNegligible;
}

template <class Visit>
bool EyePaths::goOn(Way& w, const Vertex& v, const scene::Bsdf& scattering, const EyeRay& eye, bool lightsMet,
                    const Visit& visit) const {
  const Vec3 wo = Frame(v.normal).toLocal(-v.direction);
  if (!w.parted)
    if (const auto both = scene::bothWays(scattering, wo)) {
      w.parted = true;
      Way other = w;
      if (go(other, v, scattering, (*both)[0], lightsMet)) visit(other);
      return go(w, v, scattering, (*both)[1], lightsMet);
    }
  const UnitPair a = scrambledSobol(eye.index, combineKeys(eye.key, kScatterKey + 2 * w.depth));
  const UnitPair b = scrambledSobol(eye.index, combineKeys(eye.key, kScatterKey + 2 * w.depth + 1));
  const scene::Bsdf specular = scene::specularPart(scattering);
  if (eye.trail && isLeftToChance(specular)) eye.trail->chooses();
  const auto s = scene::sample(specular, wo, {a.x, b.x, b.y});
  return s && go(w, v, scattering, *s, lightsMet);
}

void EyePaths::survey(const EyeRay& eye, Sights& sights) const { survey({eye.ray}, eye, sights); }

void EyePaths::survey(Way w, const EyeRay& eye, Sights& sights) const {
  while (w.depth <= settings_.maxDepth) {
    const tracing::Hit hit = tracer_.closestHit(w.ray);
    if (!hit) return;
    const Vertex v{hit, Vec3(hit.position), Vec3(w.ray.direction), hit.front ? Vec3(hit.normal) : -Vec3(hit.normal)};
    const scene::Bsdf& scattering = bsdf(hit.primitive, hit.front);
    if (scattering.hasFinitePart())
      if (const hierarchy::ElementId side = reconstruction_.locator.side(hit.primitive, hit.triangle, hit.front);
          side.valid())
        sights.note(reconstruction_.locator.locate(side, v.position).leaf, {v.position, v.normal});
    if (!goesOn_[scene_[hit.primitive].material.index()]) return;
    if (scattering.pane && !panesReflect_) {
      w.ray.origin = tracing::offsetOrigin(Vec3f(v.position), hit.normal, w.ray.direction);
      ++w.depth;
    } else if (!goOn(w, v, scattering, eye, false, [&](Way other) { survey(other, eye, sights); })) {
      return;
    }
  }
}

bool EyePaths::metByShadowRays(LightId id, const Lobe& lobe) const {
  const scene::LightSampler& lights = reconstruction_.lights();
  if (lights.isPointLike(id)) return true;
  const double width = kPi * double(lobe.roughness) * double(lobe.roughness);  // [sr]
  if (const auto* sun = std::get_if<SunLight>(&scene_[id].emitter)) return solidAngle(*sun) < width;
  const auto* area = std::get_if<AreaLight>(&scene_[id].emitter);
  if (!area) return false;
  const Box box = bounds(scene_[area->primitive].shape);
  const Vec3 d = box.center() - lobe.position;
  return 0.25 * kPi * glm::dot(box.extent(), box.extent()) < width * glm::dot(d, d);
}

Rgb EyePaths::background(const Way& w) const {
  const scene::LightSampler& lights = reconstruction_.lights();
  const Vec3 towards(w.ray.direction);
  Rgb L(0.0f);
  for (const LightId id : lights.atInfinity())
    if (!w.lobe || !metByShadowRays(id, *w.lobe)) L += lights.radianceFrom(id, towards);
  if (w.clear)
    for (const DomeLight& dome : scene_.backdrops) L += skyRadiance(dome, towards);
  return L;
}

Rgb EyePaths::emitted(const Way& w, const Vertex& v) const {
  const scene::LightSampler& lights = reconstruction_.lights();
  const LightId id = lights.lightOf(v.hit.primitive);
  if (!id.valid())
    return w.clear ? scene::seenRadiance(scene_.materialOf(v.hit.primitive), -v.direction, v.hit.t, v.hit.front)
                   : Rgb(0.0f);
  if (w.lobe && metByShadowRays(id, *w.lobe)) return Rgb(0.0f);
  return lights.emittedRadiance(id, -v.direction, double(v.hit.t), v.hit.front);
}

Rgb EyePaths::scattered(const Vertex& v, const EyeRay& eye, int depth, Sights& sights, bool& lightsMet) const {
  const scene::Bsdf& b = bsdf(v.hit.primitive, v.hit.front);
  if (!b.hasFinitePart()) return Rgb(0.0f);
  const scene::Bsdf lobes = scene::specularPart(b);
  const bool glossy = lobes.hasFinitePart();
  const Rgb tint = scene::textureTint(scene_, v.hit.primitive, v.hit.triangle, v.position);
  lightsMet = glossy && settings_.shadowRays > 0;
  Rgb diffuse(0.0f), highlights(0.0f);
  const auto from = [&](bool front) {
    return irradiance(v, front, glossy ? &lobes : nullptr, eye, depth, sights, highlights);
  };
  if (!isBlack(b.diffuseReflection) || glossy) diffuse += b.diffuseReflection * from(v.hit.front);
  if (!isBlack(b.diffuseTransmission) || !isBlack(lobes.transmission.reflectance))
    diffuse += b.diffuseTransmission * from(!v.hit.front);
  return float(1 / kPi) * tint * diffuse + highlights;
}

Rgb EyePaths::irradiance(const Vertex& v, bool front, const scene::Bsdf* lobes, const EyeRay& eye, int depth,
                         Sights& sights, Rgb& glossy) const {
  const hierarchy::ElementId side = reconstruction_.locator.side(v.hit.primitive, v.hit.triangle, front);
  if (!side.valid()) return Rgb(0.0f);
  const hierarchy::LeafPoint at = reconstruction_.locator.locate(side, v.position);
  if (eye.trail) eye.trail->read(at.leaf);
  Rgb E = reconstruction_.field.indirect(at, Vec3f(v.position));
  if (const auto caustic = causticLight(caustics_, scene_, v.hit.primitive, v.hit.triangle, front, v.position))
    E += *caustic;
  if (settings_.shadowRays == 0) return E + reconstruction_.field.direct(at, Vec3f(v.position));

  const direct::Receiver receiver{v.position, v.sideNormal(front)};
  const std::uint64_t key = combineKeys(eye.key, (front == v.hit.front ? kShadowKey : kOtherSideKey) + depth);
  const Frame frame(v.normal);
  const Vec3 wo = frame.toLocal(-v.direction);
  sights.sample(at.leaf, receiver, settings_.shadowRays, eye.index, key, [&](const auto& a) {
    E += static_cast<float>(glm::dot(a.direction, receiver.normal)) * a.E;
    if (!lobes) return;
    const Vec3 wi = frame.toLocal(a.direction);
    const SpecularLobe& lobe = wi.z > 0 ? lobes->reflection : lobes->transmission;
    if (lobe.roughness > 0 && metByShadowRays(a.light, {v.position, lobe.roughness}))
      glossy += scene::evaluate(*lobes, wo, wi) * a.E;
  });
  return E;
}

}  // namespace deltalux::rendering
