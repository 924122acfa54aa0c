#pragma once
// What single lamps bring to a patch, kept apart, so that dimming one needs no ray. Light is linear in the lamps.
#include <deltalux/ids.hpp>
#include <deltalux/units.hpp>
#include <span>
#include <vector>

namespace deltalux::direct {

/// What shadow rays from points of a patch to one lamp have met, by a bit a point: nothing at all, or what stops light.
/// Those that passed panes are in neither.
struct LampShadows {
  std::uint64_t clear = 0, shut = 0;

  bool knows(std::size_t point) const { return ((clear | shut) >> point & 1) != 0; }
};

/// Of one lamp or sun, at its nominal scale.
struct LampLight {
  LightId lamp;
  Rgb E{0.0f};               // [W/m2]
  float variance = 0;        // of its mean, gray
  std::uint32_t points = 0;  // of the patch, the first ones, that have asked it by rays of their own
  LampShadows shadows{};     // of those
};

/// That of a lamp that has been asked by rays of its own; nullptr.
const LampLight* askedLight(std::span<const LampLight>, LightId);

/// Of all of them, each times its dimming.
struct DimmedLight {
  Rgb E{0.0f};          // [W/m2]
  float deviation = 0;  // standard error of it, gray
};
/// `dimming`: by light. [scene/nominal_scale.hpp]
DimmedLight dimmed(std::span<const LampLight>, std::span<const Rgb> dimming);

/// Adds what rays have found that each chose a lamp: `found` has the sums, a lamp as often as it was chosen; `samples`
/// were all rays, and their mean has that variance, which is shared out by what each lamp has brought.
void addDrawn(std::vector<LampLight>& to, std::vector<LampLight> found, int samples, double variance);

}  // namespace deltalux::direct
