#pragma once
// Scattering at one surface point: evaluate, sample and pdf of every material, for path tracing and for particles.
//
// Directions are local and unit, z along the normal of the side that `wo` is on (wo.z > 0); both point away from the
// surface. Diffuse parts are Lambertian. Rough lobes are Ward's in the energy-bounded form (bsdf_ward.hpp) or GGX
// (bsdf_ggx.hpp); a rough transmission lobe is the reflection lobe seen through the surface. At roughness 0 a lobe is
// perfect. Reciprocal and never above the material's reflectance, except that refraction scales radiance (etaSquared).
//
// Perfect parts (mirror, straight passage, refraction) are Dirac: they are met by sample() alone, with pdf 0, and take
// no part in evaluate() and pdf(), which speak of the rest.
#include <array>
#include <deltalux/material.hpp>
#include <optional>

namespace deltalux::scene {

/// What a material does on one of its sides. `ior` is the medium's behind over the one before the surface.
struct Bsdf {
  Rgb diffuseReflection{0.0f};
  Rgb diffuseTransmission{0.0f};
  SpecularLobe reflection;
  SpecularLobe transmission;
  std::optional<ThinGlass> pane;
  float paneCoverage = 1;    // share of the surface that is pane
  Rgb passage{0.0f};         // straight on beside what is covered
  bool paneReflects = true;  // false: light only passes straight on
  bool panePasses = true;    // false: it only reflects
  std::optional<double> refractingIor;

  /// Whether anything but Dirac parts is there: a surface light can be connected to.
  bool hasFinitePart() const;
};

enum class ScatterEvent : unsigned char {
  DiffuseReflection,
  DiffuseTransmission,
  GlossyReflection,
  GlossyTransmission,
  MirrorReflection,      // Dirac from here on
  StraightTransmission,  // a smooth transmission lobe
  Refraction,
  Passage,  // straight on, as shadow rays pass: panes, and what is not covered
};
constexpr bool isDirac(ScatterEvent e) { return e >= ScatterEvent::MirrorReflection; }

struct BsdfSample {
  Vec3 direction;  // wi; below the surface (z < 0) for transmission
  Rgb weight;      // f |cos| / density; for Dirac events reflectance over the chance of being chosen
  double pdf = 0;  // of all finite parts together, per solid angle [1/sr]; 0 for Dirac events
  ScatterEvent event = ScatterEvent::DiffuseReflection;
  double etaSquared = 1;  // (n behind / n before)^2 of a refraction; carried radiance is divided by it, flux is not
};

/// The scattering of `material` seen from its front or back; `tint` multiplies the diffuse colour (textures).
Bsdf makeBsdf(const Material& material, bool front, const Rgb& tint = Rgb(1.0f));
/// The same without diffuse parts: what passes particles on.
Bsdf specularPart(Bsdf bsdf);
/// The same where light that goes straight on, as shadow rays do, has been accounted for: that part absorbs. Panes then
/// only reflect.
Bsdf withoutPassage(Bsdf bsdf);

/// f(wo, wi) |cos wi| of the finite parts [1/sr].
Rgb evaluate(const Bsdf&, const Vec3& wo, const Vec3& wi);
/// Density of sample() for the finite parts, per solid angle [1/sr]; integrates to the chance of choosing them.
double pdf(const Bsdf&, const Vec3& wo, const Vec3& wi);
/// A direction from three numbers in [0,1): u.x chooses the part, (u.y, u.z) the direction. nullopt: absorbed.
std::optional<BsdfSample> sample(const Bsdf&, const Vec3& wo, const Vec3& u);
/// Where light goes two ways and no other (a pane, a smooth body, a mirror with gaps): reflection and passage, each
/// weighted by its reflectance instead of chosen by it. Elsewhere nullopt.
std::optional<std::array<BsdfSample, 2>> bothWays(const Bsdf&, const Vec3& wo);

/// What goes straight on as shadow rays do, at `cosIncidence` > 0. Equals straightTransmittance() of the material.
Rgb passageTransmittance(const Bsdf&, double cosIncidence);
/// Reflectance of the perfect-mirror part at `cosIncidence` > 0: mirrors, panes, polished lobes, dielectrics.
Rgb mirrorReflectance(const Bsdf&, double cosIncidence);

}  // namespace deltalux::scene
