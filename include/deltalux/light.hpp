#pragma once
// Senders of light. Everything that lights a scene has an entry here, area emitters included, so that an edit can
// name it and scale it.
#include <array>
#include <deltalux/direction_table.hpp>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace deltalux {

/// A primitive whose material emits; radiance, sides and spot cone are the material's.
struct AreaLight {
  PrimitiveId primitive;

  bool operator==(const AreaLight&) const = default;
};

/// Isotropic point: I(w) = intensity [W/sr].
struct PointLight {
  Vec3 position{0};
  Rgb intensity{0.0f};

  bool operator==(const PointLight&) const = default;
};

/// glTF spot: I = intensity * saturate(cos * scale + offset)^2, with scale = 1 / max(0.001, cosInner - cosOuter),
/// offset = -cosOuter * scale. [KHR_lights_punctual]
struct SpotLight {
  Vec3 position{0};
  Vec3 direction{0, 0, -1};  // unit
  Rgb intensity{0.0f};       // on axis [W/sr]
  double cosInner = 1, cosOuter = 0.70710678118654752;

  bool operator==(const SpotLight&) const = default;
};

/// A Lambertian point: I = intensity * max(0, cos) about `direction` [CIE 171 case 5.2].
struct LambertPointLight {
  Vec3 position{0};
  Vec3 direction{0, 0, -1};  // unit
  Rgb intensity{0.0f};       // on axis [W/sr]

  bool operator==(const LambertPointLight&) const = default;
};

/// A measured distribution, type C after conversion: candela[h * verticals.size() + v] over horizontal angles
/// (degrees from the 0 plane towards +y, ascending, first 0, last 360) and vertical angles (ascending from 0 at nadir
/// to 180). Angles that were not measured are there with 0 cd. [LM-63]
struct Photometry {
  std::vector<double> verticals, horizontals;
  std::vector<double> candela;
  Vec3 opening{0};  // luminous width, length, height [m]; 0 for a point; width, length negative of round ones
};

/// A luminaire as a point of measured intensity: I(w) = candela(w) / 179 * scale.
/// Columns of `frame`: 0 plane, 90 plane, and the axis that points from the luminaire backwards (aim is -axis).
struct PhotometricLight {
  Vec3 position{0};
  glm::dmat3 frame{1.0};  // local to world; local aim is -z, 0 plane along +x (ies2rad's frame)
  std::shared_ptr<const Photometry> photometry;
  Rgb scale{1.0f};

  bool operator==(const PhotometricLight&) const = default;
};

/// A uniform disc at infinity, such as the sun: radiance within `angularRadius` of `direction`.
struct SunLight {
  Vec3 direction{0, 0, 1};  // unit, towards the sun
  double angularRadius = 0.004654793;
  Rgb radiance{0.0f};

  bool operator==(const SunLight&) const = default;
};

/// gensky's distributions [Radiance, skybright.cal] in W/(sr m2): brightness of the sky and of the ground below.
struct RadianceSky {
  enum class Kind { Clear = 1, Overcast = 2, Uniform = 3, Intermediate = 4 };
  Kind kind = Kind::Clear;
  double zenith = 0, ground = 0, normalization = 1;  // as gensky prints them (A2, A3, A4)
  Vec3 sunDirection{0, 0, 1};

  bool operator==(const RadianceSky&) const = default;
};

/// CIE standard general sky, types 1-15 [ISO 15469].
struct CieSky {
  int type = 12;
  double zenith = 1;  // zenith radiance [W/(sr m2)]
  double ground = 0;  // radiance below the horizon
  Vec3 sunDirection{0, 0, 1};

  bool operator==(const CieSky&) const = default;
};

/// The all-weather sky, as gendaylit parametrises it: above the horizon
///   L = diffuse (1 + a exp(b / cos zenith)) (1 + c exp(d gamma) + e cos^2 gamma),   gamma: the angle to the sun,
/// and `ground` below. [PSM93 (1); Radiance, perezlum.cal]
struct PerezSky {
  double diffuse = 1, ground = 0;                     // [W/(sr m2)]
  std::array<double, 5> coefficients{0, 0, 0, 0, 0};  // a b c d e
  Vec3 sunDirection{0, 0, 1};

  bool operator==(const PerezSky&) const = default;
};

/// Any other sky: radiance [W/(sr m2)] by the direction it comes from.
struct TabulatedSky {
  std::shared_ptr<const DirectionTable> table;
  glm::dmat3 frame{1.0};  // orthogonal; the table's axes in the world

  bool operator==(const TabulatedSky&) const = default;
};

struct UniformSky {
  double radiance = 1;

  bool operator==(const UniformSky&) const = default;
};

/// Radiance from infinity within `halfAngle` of `axis`: scale * distribution(direction). Sky, ground, windows' worlds.
struct DomeLight {
  Vec3 axis{0, 0, 1};  // unit
  double halfAngle = kPi / 2;
  Rgb scale{1.0f};
  std::variant<UniformSky, RadianceSky, CieSky, PerezSky, TabulatedSky> distribution;
  Vec3 up{0, 0, 1};  // zenith of the distribution

  bool operator==(const DomeLight&) const = default;
};

struct Light {
  std::string name;
  std::variant<AreaLight, PointLight, SpotLight, LambertPointLight, PhotometricLight, SunLight, DomeLight> emitter;
  Rgb scale{1.0f};       // an edit's dimming and colour, on top of the emitter's own values
  bool standby = false;  // of suns and skies: sampled as if it were on, so that switching it on traces no ray
};

/// Radiance that arrives from `towards` (unit, pointing to the sky) [W/(sr m2)]; 0 outside the dome's cone.
Rgb skyRadiance(const DomeLight&, const Vec3& towards);
/// Radiant intensity into `direction` (unit, leaving the light) [W/sr].
Rgb radiantIntensity(const PointLight&, const Vec3& direction);
Rgb radiantIntensity(const SpotLight&, const Vec3& direction);
Rgb radiantIntensity(const LambertPointLight&, const Vec3& direction);
Rgb radiantIntensity(const PhotometricLight&, const Vec3& direction);
/// Luminous intensity [cd] at `vertical` in [0,180] and `horizontal` in [0,360] degrees, interpolated between the
/// angles.
double candela(const Photometry&, double vertical, double horizontal);
/// Luminous flux of the whole distribution [lm], exactly as candela() interpolates it.
double luminousFlux(const Photometry&);
/// Solid angle of the sun's disc [sr].
double solidAngle(const SunLight&);

}  // namespace deltalux
