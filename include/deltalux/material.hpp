#pragma once
// What a surface does with light. Decisions shared with the reference values: plastic's diffuse part is
// colour (1 - specular) and its specular part uncoloured; no Fresnel boost of opaque speculars; roughness 0 is a
// perfect mirror; emitters of .rad scenes do not reflect.
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
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

/// Radiance's spotlight: emission only within the cone, E = L A cos cos' / (d + |direction|)^2. [conventions.md]
struct SpotCone {
  double fullAngle = kPi;    // radians
  Vec3 direction{0, 0, -1};  // its length is the focal offset, in scene units

  bool operator==(const SpotCone&) const = default;
};

/// Diffuse emission of a surface's front side.
struct Emission {
  Rgb radiance{0.0f};  // L [W/(sr m2)]; exitance M = pi L
  bool bothSides = false;
  std::optional<SpotCone> spot;
  bool seenOnly = false;  // by cameras and in mirrors: it lights nothing [Radiance, glow of negative radius]

  bool operator==(const Emission&) const = default;
};

struct Material {
  std::string name;
  Surface surface = Opaque{};
  std::optional<Emission> emission;
};

/// Whether a surface of it lights others.
inline bool sendsLight(const Material& m) { return m.emission && !m.emission->seenOnly; }

/// What a material does, told apart as the solver needs it: fractions of incident flux at the front (back) side.
Rgb diffuseReflectance(const Material&, bool front);
Rgb diffuseTransmittance(const Material&);
/// True when light can leave other than diffusely (mirror, lobe, refraction): such receivers get particles. [GD01 2.1]
bool isSpecular(const Material&);
/// True for panes through which shadow rays pass straight, attenuated.
bool isThinGlass(const Material&);

/// Fractions that a pane passes straight on and reflects at `cosIncidence` in (0,1]; unpolarised Fresnel with all
/// internal reflections. [Radiance, glass: m_glass]
Rgb transmittance(const ThinGlass&, double cosIncidence);
Rgb reflectance(const ThinGlass&, double cosIncidence);
/// Unpolarised Fresnel reflectance from a medium of relative index 1 into `ior` (pass 1/ior from inside); 1 under total
/// internal reflection.
double fresnelDielectric(double cosIncidence, double ior);

}  // namespace deltalux
