#pragma once
// What a surface does with light. Decisions shared with the reference values: plastic's diffuse part is
// colour (1 - specular) and its specular part uncoloured; no Fresnel boost of opaque speculars; roughness 0 is a
// perfect mirror; emitters of .rad scenes do not reflect.
#include <deltalux/direction_table.hpp>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace deltalux {

/// A specular lobe: directional-hemispherical reflectance per channel, constant over angle.
struct SpecularLobe {
  enum class Distribution { Ward, Ggx };
  Rgb reflectance{0.0f};   // 0: no lobe
  float roughness = 0.0f;  // Ward: rms slope alpha; GGX: alpha (glTF roughness squared); 0: perfect mirror
  Distribution distribution = Distribution::Ward;

  bool operator==(const SpecularLobe&) const = default;
};

/// Plastic, metal, glTF metallic-roughness: reflects on both sides, transmits nothing.
struct Opaque {
  Rgb diffuse{0.0f};         // rho, Lambertian
  TextureId diffuseTexture;  // multiplies `diffuse` over mesh texture coordinates, when valid
  SpecularLobe specular;

  bool operator==(const Opaque&) const = default;
};

/// Radiance `mirror`: a perfect mirror on the front, black on the back.
struct Mirror {
  Rgb reflectance{0.0f};

  bool operator==(const Mirror&) const = default;
};

/// A thin pane: no refraction offset; passes light straight through and reflects. Transmission and reflection follow
/// from `transmissivity` per passage at normal incidence and Fresnel at `ior`. [Radiance, glass]
struct ThinGlass {
  Rgb transmissivity{1.0f};
  float ior = 1.52f;

  bool operator==(const ThinGlass&) const = default;
};

/// A closed refracting body. Inside (behind the front side), light is attenuated by transmission^length.
struct Dielectric {
  Rgb transmission{1.0f};  // per unit length (scene units)
  float ior = 1.5f;        // relative to the outside

  bool operator==(const Dielectric&) const = default;
};

/// Radiance `trans`: diffuse reflection and diffuse transmission, a specular reflection and a transmission lobe.
struct Trans {
  Rgb diffuseReflectance{0.0f};
  Rgb diffuseTransmittance{0.0f};
  SpecularLobe reflection;
  SpecularLobe transmission;

  bool operator==(const Trans&) const = default;
};

using Surface = std::variant<Opaque, Mirror, ThinGlass, Dielectric, Trans>;

/// Radiance's spotlight: emission only within the cone, E = L A cos cos' / (d + |direction|)^2. [Radiance, spotlight]
struct SpotCone {
  double fullAngle = kPi;    // radians
  Vec3 direction{0, 0, -1};  // its length is the focal offset, in scene units

  bool operator==(const SpotCone&) const = default;
};

/// Emission that depends on direction: towards unit w, Emission::radiance times scale * table(w), or, where `normal` is
/// given, scale * table(w) / |w . normal|: the table is then that of a flat source's intensity, which stays finite
/// where the surface is seen edge-on. `scale` makes the mean over the emitter, weighted by cosine, 1, so that M = pi L
/// holds.
struct EmissionPattern {
  std::shared_ptr<const DirectionTable> table;
  glm::dmat3 frame{1.0};  // orthogonal; the table's axes in the world
  double scale = 1;
  std::optional<Vec3> normal;  // unit

  bool operator==(const EmissionPattern&) const = default;
};

/// Emission of a surface's front side, diffuse unless a cone or a pattern says otherwise.
struct Emission {
  Rgb radiance{0.0f};  // L [W/(sr m2)]; exitance M = pi L
  bool bothSides = false;
  std::optional<SpotCone> spot;
  std::optional<EmissionPattern> pattern = std::nullopt;
  bool seenOnly = false;  // by cameras and in mirrors: it lights nothing [Radiance, glow of negative radius]

  bool operator==(const Emission&) const = default;
};

/// What covers a share of a surface, evenly and finer than anything that is told apart; light goes straight on through
/// the rest, as much at every angle. `surface` is that of the covered part, `emission` that of the whole.
struct Material {
  std::string name;
  Surface surface = Opaque{};
  std::optional<Emission> emission;
  float coverage = 1;  // covered share, 0 to 1; alpha of glTF, dissolve of MTL. Below 1 no surface may be a Dielectric
  Rgb filter{1.0f};    // of what passes beside it
};

/// Whether a surface of it lights others.
inline bool sendsLight(const Material& m) { return m.emission && !m.emission->seenOnly; }
/// Radiance towards unit `direction`, relative to Emission::radiance.
double relativeRadiance(const EmissionPattern&, const Vec3& direction);
/// The same with all that depends on direction and on the distance to what is lit [scene units]; 1 for diffuse
/// emission.
double relativeRadiance(const Emission&, const Vec3& direction, double distance);
/// Whether emission depends on direction.
inline bool isDirectional(const Emission& emission) { return emission.spot || emission.pattern; }
/// Turns what depends on direction with the surface; the matrix may scale uniformly.
void turn(Emission&, const glm::dmat3&);

/// What a material does, told apart as the solver needs it: fractions of incident flux at the front (back) side.
Rgb diffuseReflectance(const Material&, bool front);
Rgb diffuseTransmittance(const Material&);
/// True when light can leave other than diffusely (mirror, lobe, refraction): such receivers get particles. [GD01 2.1]
bool isSpecular(const Material&);
/// True where shadow rays pass, attenuated: panes of thin glass, and surfaces that are not covered all over.
bool passesStraight(const Material&);
/// Fraction that a surface passes straight on at `cosIncidence` in (0,1], so that shadow rays find it; what a trans
/// material's lobe passes on is not in it.
Rgb straightTransmittance(const Material&, double cosIncidence);
/// True where no diffuse side takes light: panes, refracting bodies, and where nothing is covered.
bool isClear(const Material&);
/// Those that pass light straight on: whoever looks at them sees what is behind.
bool isPane(const Material&);

/// Fractions that a pane passes straight on and reflects at `cosIncidence` in (0,1]; unpolarised Fresnel with all
/// internal reflections. [Radiance, glass: m_glass]
Rgb transmittance(const ThinGlass&, double cosIncidence);
Rgb reflectance(const ThinGlass&, double cosIncidence);
/// Unpolarised Fresnel reflectance from a medium of relative index 1 into `ior` (pass 1/ior from inside); 1 under total
/// internal reflection.
double fresnelDielectric(double cosIncidence, double ior);

}  // namespace deltalux
