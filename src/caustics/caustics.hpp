#pragma once
// All caustic textures of a solution: which sides of which surfaces have them, and light looked up there. Where a side
// has textures they show all of its particles' irradiance; elsewhere the mesh does. Never both.
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "caustics/caustic_texture.hpp"
#include "particles/impact.hpp"

namespace deltalux::caustics {

struct Caustics {
  std::vector<SurfaceCaustics> surfaces;                  // ascending by primitive, front before back
  std::vector<std::array<std::uint32_t, 2>> ofPrimitive;  // index of front and back into `surfaces`, or kNone

  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  /// The textures of a side; nullptr where the mesh shows the particles.
  const SurfaceCaustics* of(PrimitiveId primitive, bool front) const {
    if (primitive.index() >= ofPrimitive.size()) return nullptr;
    const std::uint32_t index = ofPrimitive[primitive.index()][front ? 0 : 1];
    return index == kNone ? nullptr : &surfaces[index];
  }
  std::size_t count() const;  // textures
  double meanSize() const;    // square root of their texels, on average
  std::size_t memoryBytes() const;
};

/// Sides of surfaces, by 2 * primitive + (front ? 0 : 1).
using SurfaceSides = std::vector<bool>;

struct CausticSettings;

/// How the textures of one side are chosen, and made: of the impacts on it.
struct TextureRule {
  bool (*deserves)(const Shape&, std::span<const particles::Impact>, const CausticSettings&);
  std::optional<SurfaceCaustics> (*make)(const Shape&, std::span<const particles::Impact>, const CausticSettings&);
};
/// By the target error alone (adaptive_textures.hpp).
TextureRule adaptiveRule();

/// Which sides need textures for what was deposited there, in any order. Light that is not the particles' is read from
/// the elements: errors are measured against it.
SurfaceSides sidesWithTextures(const Scene&, const hierarchy::Elements&, std::vector<particles::Impact>, double error,
                               const TextureRule& = adaptiveRule());

/// The textures of all sides that need them. The same for any number of threads. Cost: about 0.25 microseconds a texel.
Caustics makeCaustics(const Scene&, const hierarchy::Elements&, std::vector<particles::Impact>, double error,
                      const TextureRule& = adaptiveRule());

/// Gray irradiance of all light but the particles', by side: errors are measured against it, too. [W/m2]
struct OtherLight {
  std::vector<double> mean;
  std::vector<double> darkest;  // in the darkest tenth of what light can reach; 0 on sides that were not asked for
};
/// `sides`: that are asked for.
OtherLight otherLight(const Scene&, const hierarchy::Elements&, const SurfaceSides&);
std::vector<double> meanOtherLight(const Scene&, const hierarchy::Elements&);

/// Evaluates all that was deposited on the sides `remade`, and makes the textures of those that need them; others are
/// not touched. Returns how many textures it made.
std::size_t remakeCaustics(Caustics&, const Scene&, const hierarchy::Elements&, std::vector<particles::Impact>,
                           double error, const std::vector<char>& remade, const TextureRule& = adaptiveRule());

/// Multiplies the textures of a side so that they hold `flux`, when they are off by more than `tolerance` of it.
bool rescale(SurfaceCaustics&, const RgbSum& flux, double tolerance);

/// Recounts: every texture holds its flux, the index finds every side. Throws std::logic_error.
void validate(const Caustics&);

}  // namespace deltalux::caustics
