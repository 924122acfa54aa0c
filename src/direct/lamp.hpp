#pragma once
// One sun or lamp as patches see it: about how much it may bring, without a ray.
#include "base/random.hpp"
#include "hierarchy/element.hpp"

namespace deltalux::direct {

/// Directions that something emits into: within `angle` of a unit axis.
struct EmissionCone {
  Vec3f axis{0, 0, 1};
  float cosine = -1, sine = 0;  // of the angle
};
struct Lamp {
  LightId id;
  bool sun = false;
  Vec3f lower{0.0f}, upper{0.0f};  // box; of suns nothing
  Vec3 axis{0, 0, 1};              // of the sun's disc, of a spot's cone, or the normal of a flat lamp
  double halfAngle = kPi;          // that the light stays within about the axis, or the sun's disc [radians]
  bool flat = false;               // one-sided and plane: nothing behind it is lit
  double beam = kPi;               // half angle of where it is brightest, when narrow: it may fall between samples
  EmissionCone cone;               // that all its light stays within, but of suns
  double most = 0;                 // greatest intensity over directions, about [W/sr, gray]; of suns irradiance [W/m2]
};

/// Stands for a lamp in a set of some; for several lamps where there are many.
inline std::uint64_t lampBit(LightId id) { return std::uint64_t(1) << (id.value % 64); }
/// Three bits that stand for a lamp in a set of few, out of which hardly any others come.
inline std::uint64_t lampBits(LightId id) {
  const std::uint64_t mixed = mix64(id.value);
  return std::uint64_t(1) << (mixed & 63) | std::uint64_t(1) << (mixed >> 6 & 63) |
         std::uint64_t(1) << (mixed >> 12 & 63);
}

/// Irradiance that a lamp may bring to a patch, about, unshadowed [W/m2, gray]; 0 where it provably cannot: it lies
/// behind the patch, the patch behind it, or outside its cone.
double potential(const Lamp&, const hierarchy::ElementGeometry&);
/// Whether a lamp lies below the horizon of a point with that unit normal: no sample of it brings anything there.
bool isBelow(const Lamp&, const Vec3f& at, const Vec3f& normal);
bool isNarrow(const Lamp&);
/// Width of a narrow beam at a patch that may lie in it [scene units]; infinite for all others.
double beamWidth(const Lamp&, const hierarchy::ElementGeometry&);

EmissionCone emissionCone(const Vec3& axis, double angle);
EmissionCone emissionCone(const Lamp&);
EmissionCone joined(const EmissionCone&, const EmissionCone&);

/// Lamps within a sphere, as a patch sees them.
struct LampSphere {
  Vec3f center{0.0f}, half{0.0f};  // of the box
  float radius = 0;                // of the box's sphere
  EmissionCone cone;
};
/// Greatest cosine that light of theirs may fall on the patch at; 0 where none provably does.
float greatestCosine(const LampSphere&, const hierarchy::ElementGeometry&);

}  // namespace deltalux::direct
