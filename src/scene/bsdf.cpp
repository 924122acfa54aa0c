#include "scene/bsdf.hpp"

#include "base/unit_circle.hpp"
#include "scene/bsdf_ggx.hpp"
#include "scene/bsdf_ward.hpp"

namespace deltalux::scene {

namespace {

bool isRough(const SpecularLobe& lobe) { return lobe.roughness > 0.0f && !isBlack(lobe.reflectance); }

double lobeValue(const SpecularLobe& lobe, const Vec3& wo, const Vec3& wi) {
  return lobe.distribution == SpecularLobe::Distribution::Ward ? ward::evaluate(lobe.roughness, wo, wi)
                                                               : ggx::evaluate(lobe.roughness, wo, wi);
}
double lobePdf(const SpecularLobe& lobe, const Vec3& wo, const Vec3& wi) {
  return lobe.distribution == SpecularLobe::Distribution::Ward ? ward::pdf(lobe.roughness, wo, wi)
                                                               : ggx::pdf(lobe.roughness, wo, wi);
}
Vec3 lobeDirection(const SpecularLobe& lobe, const Vec3& wo, const Vec2& u) {
  return lobe.distribution == SpecularLobe::Distribution::Ward ? ward::sample(lobe.roughness, wo, u)
                                                               : ggx::sample(lobe.roughness, wo, u);
}

Vec3 cosineDirection(const Vec2& u) { return Vec3(std::sqrt(u.x) * onUnitCircle(u.y), std::sqrt(1.0 - u.x)); }

Vec3 throughSurface(const Vec3& w) { return {w.x, w.y, -w.z}; }

/// Chances of choosing each part, in the order of ScatterEvent, proportional to the brightest channel.
struct Choice {
  std::array<double, 8> chance{};
  Rgb mirror{0.0f}, straight{0.0f}, passage{0.0f};  // colours of the Dirac parts
};

Choice choose(const Bsdf& bsdf, double cosIncidence) {
  Choice c;
  const auto at = [&](ScatterEvent e) -> double& { return c.chance[static_cast<std::size_t>(e)]; };
  at(ScatterEvent::DiffuseReflection) = maxChannel(bsdf.diffuseReflection);
  at(ScatterEvent::DiffuseTransmission) = maxChannel(bsdf.diffuseTransmission);
  if (isRough(bsdf.reflection)) {
    at(ScatterEvent::GlossyReflection) = maxChannel(bsdf.reflection.reflectance);
  } else {
    c.mirror = mirrorReflectance(bsdf, cosIncidence);
    at(ScatterEvent::MirrorReflection) = maxChannel(c.mirror);
  }
  if (isRough(bsdf.transmission)) {
    at(ScatterEvent::GlossyTransmission) = maxChannel(bsdf.transmission.reflectance);
  } else if (bsdf.refractingIor) {
    at(ScatterEvent::Refraction) = 1.0 - c.mirror.r;
  } else {
    c.straight = bsdf.transmission.reflectance;
    at(ScatterEvent::StraightTransmission) = maxChannel(c.straight);
  }
  c.passage = passageTransmittance(bsdf, cosIncidence);
  at(ScatterEvent::Passage) = maxChannel(c.passage);
  double sum = 0;
  for (double& p : c.chance) sum += p = std::max(0.0, p);
  for (double& p : c.chance) p = sum > 0 ? p / sum : 0.0;
  return c;
}

double finitePdf(const Bsdf& bsdf, const Choice& c, const Vec3& wo, const Vec3& wi) {
  const auto chance = [&](ScatterEvent e) { return c.chance[static_cast<std::size_t>(e)]; };
  const bool reflected = wi.z > 0.0;
  const double diffuse = chance(reflected ? ScatterEvent::DiffuseReflection : ScatterEvent::DiffuseTransmission);
  const double glossy = chance(reflected ? ScatterEvent::GlossyReflection : ScatterEvent::GlossyTransmission);
  double density = diffuse * std::abs(wi.z) / kPi;
  if (glossy > 0.0) {
    density +=
        glossy * (reflected ? lobePdf(bsdf.reflection, wo, wi) : lobePdf(bsdf.transmission, wo, throughSurface(wi)));
  }
  return density;
}

std::optional<BsdfSample> finiteSample(const Bsdf& bsdf, const Choice& c, const Vec3& wo, ScatterEvent event,
                                       const Vec2& u) {
  Vec3 wi;
  switch (event) {
    case ScatterEvent::DiffuseReflection:
      wi = cosineDirection(u);
      break;
    case ScatterEvent::DiffuseTransmission:
      wi = throughSurface(cosineDirection(u));
      break;
    case ScatterEvent::GlossyReflection:
      wi = lobeDirection(bsdf.reflection, wo, u);
      break;
    default:
      wi = throughSurface(lobeDirection(bsdf.transmission, wo, u));
      break;
  }
  const bool reflection = event == ScatterEvent::DiffuseReflection || event == ScatterEvent::GlossyReflection;
  if (reflection ? wi.z <= 0.0 : wi.z >= 0.0) return std::nullopt;
  const double density = finitePdf(bsdf, c, wo, wi);
  if (!(density > 0.0)) return std::nullopt;
  return BsdfSample{wi, evaluate(bsdf, wo, wi) * static_cast<float>(1.0 / density), density, event, 1.0};
}

BsdfSample diracSample(const Bsdf& bsdf, const Choice& c, const Vec3& wo, ScatterEvent event) {
  const float chance = static_cast<float>(c.chance[static_cast<std::size_t>(event)]);
  if (event == ScatterEvent::MirrorReflection) return {{-wo.x, -wo.y, wo.z}, c.mirror / chance, 0.0, event, 1.0};
  if (event == ScatterEvent::StraightTransmission) return {-wo, c.straight / chance, 0.0, event, 1.0};
  if (event == ScatterEvent::Passage) return {-wo, c.passage / chance, 0.0, event, 1.0};
  const double ior = *bsdf.refractingIor;
  const double cosInside = std::sqrt(std::max(0.0, 1.0 - (1.0 - wo.z * wo.z) / (ior * ior)));
  const Vec3 wi(-wo.x / ior, -wo.y / ior, -cosInside);
  return {glm::normalize(wi), Rgb((1.0f - c.mirror.r) / chance), 0.0, event, ior * ior};
}

}  // namespace

bool Bsdf::hasFinitePart() const {
  return !isBlack(diffuseReflection) || !isBlack(diffuseTransmission) || isRough(reflection) || isRough(transmission);
}

Bsdf makeBsdf(const Material& material, bool front, const Rgb& tint) {
  Bsdf bsdf;
  if (const auto* opaque = std::get_if<Opaque>(&material.surface)) {
    bsdf.diffuseReflection = opaque->diffuse * tint;
    bsdf.reflection = opaque->specular;
  } else if (const auto* mirror = std::get_if<Mirror>(&material.surface)) {
    if (front) bsdf.reflection.reflectance = mirror->reflectance;
  } else if (const auto* glass = std::get_if<ThinGlass>(&material.surface)) {
    bsdf.pane = *glass;
  } else if (const auto* body = std::get_if<Dielectric>(&material.surface)) {
    bsdf.refractingIor = front ? body->ior : 1.0 / body->ior;
  } else if (const auto* trans = std::get_if<Trans>(&material.surface)) {
    bsdf.diffuseReflection = trans->diffuseReflectance * tint;
    bsdf.diffuseTransmission = trans->diffuseTransmittance * tint;
    bsdf.reflection = trans->reflection;
    bsdf.transmission = trans->transmission;
  }
  const float share = material.coverage;
  bsdf.diffuseReflection *= share, bsdf.diffuseTransmission *= share;
  bsdf.reflection.reflectance *= share, bsdf.transmission.reflectance *= share;
  bsdf.paneCoverage = share;
  bsdf.passage = (1 - share) * material.filter;
  return bsdf;
}

Bsdf specularPart(Bsdf bsdf) {
  bsdf.diffuseReflection = bsdf.diffuseTransmission = Rgb(0.0f);
  return bsdf;
}

Bsdf withoutPassage(Bsdf bsdf) {
  bsdf.passage = Rgb(0.0f);
  bsdf.panePasses = false;
  return bsdf;
}

Rgb passageTransmittance(const Bsdf& bsdf, double cosIncidence) {
  if (!bsdf.pane || !bsdf.panePasses) return bsdf.passage;
  return bsdf.passage + bsdf.paneCoverage * transmittance(*bsdf.pane, cosIncidence);
}

Rgb mirrorReflectance(const Bsdf& bsdf, double cosIncidence) {
  if (bsdf.pane) return bsdf.paneReflects ? bsdf.paneCoverage * reflectance(*bsdf.pane, cosIncidence) : Rgb(0.0f);
  if (bsdf.refractingIor) return Rgb(static_cast<float>(fresnelDielectric(cosIncidence, *bsdf.refractingIor)));
  return bsdf.reflection.roughness > 0.0f ? Rgb(0.0f) : bsdf.reflection.reflectance;
}

Rgb evaluate(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (wo.z <= 0.0 || wi.z == 0.0) return Rgb(0.0f);
  const bool reflected = wi.z > 0.0;
  const float cosine = static_cast<float>(std::abs(wi.z));
  Rgb f = (reflected ? bsdf.diffuseReflection : bsdf.diffuseTransmission) * static_cast<float>(1.0 / kPi);
  const SpecularLobe& lobe = reflected ? bsdf.reflection : bsdf.transmission;
  if (isRough(lobe))
    f += lobe.reflectance * static_cast<float>(lobeValue(lobe, wo, reflected ? wi : throughSurface(wi)));
  return f * cosine;
}

double pdf(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi) {
  if (wo.z <= 0.0 || wi.z == 0.0) return 0.0;
  return finitePdf(bsdf, choose(bsdf, wo.z), wo, wi);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, const Vec3& wo, const Vec3& u) {
  if (wo.z <= 0.0) return std::nullopt;
  const Choice c = choose(bsdf, wo.z);
  double rest = u.x;
  int chosen = -1;
  for (int i = 0; i < static_cast<int>(c.chance.size()); ++i) {
    if (c.chance[i] <= 0.0) continue;
    chosen = i;
    if (rest < c.chance[i]) break;
    rest -= c.chance[i];
  }
  if (chosen < 0) return std::nullopt;
  const auto event = static_cast<ScatterEvent>(chosen);
  return isDirac(event) ? std::optional(diracSample(bsdf, c, wo, event)) : finiteSample(bsdf, c, wo, event, {u.y, u.z});
}

std::optional<std::array<BsdfSample, 2>> bothWays(const Bsdf& bsdf, const Vec3& wo) {
  if (wo.z <= 0.0 || bsdf.hasFinitePart()) return std::nullopt;
  Choice c = choose(bsdf, wo.z);
  const auto chance = [&](ScatterEvent e) -> double& { return c.chance[static_cast<std::size_t>(e)]; };
  auto onward = ScatterEvent::MirrorReflection;
  int ways = 0;
  for (const auto e : {ScatterEvent::StraightTransmission, ScatterEvent::Refraction, ScatterEvent::Passage})
    if (chance(e) > 0) onward = e, ++ways;
  if (!(chance(ScatterEvent::MirrorReflection) > 0) || ways != 1) return std::nullopt;
  chance(ScatterEvent::MirrorReflection) = chance(onward) = 1;
  return std::array{diracSample(bsdf, c, wo, ScatterEvent::MirrorReflection), diracSample(bsdf, c, wo, onward)};
}

}  // namespace deltalux::scene
