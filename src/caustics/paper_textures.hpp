#pragma once
// Caustic textures as the paper makes them, by its fixed values [GD01 3]: one texture a surface (or one a lit region),
// each of the resolution that all of the surface's particles ask for. For comparison: adaptive_textures.hpp is what
// solutions use. Departures: the spiral keeps flux (spiral.hpp); what lies outside all lit regions stays in a texture
// of the whole surface instead of being dropped.
#include <optional>

#include "caustics/caustic_texture.hpp"
#include "particles/impact.hpp"

namespace deltalux::caustics {

struct PaperThresholds {
  std::size_t leastParticles = 10;  // fewer are left to the mesh [GD01 3.1]
  double contrast = 0.5;            // eta; the paper names no value
  double variance = 1;              // epsilon [GD01 3.2]
  int radius = 8;                   // R in texels; the paper names no value
  double lit = 0.02;                // of the maximum, from which a texel is lit [GD01 3.3]: "between 1 and 5 %"
  bool restricted = true;           // to lit regions; false: one texture over the whole surface
};

/// Textures for impacts on one side of a surface; nullopt where the mesh will do.
std::optional<SurfaceCaustics> makePaperTextures(const Shape&, std::span<const particles::Impact>,
                                                 const PaperThresholds& = {});

}  // namespace deltalux::caustics
