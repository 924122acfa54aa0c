#pragma once
// Caustic textures [GD01 3]: one a surface, or one for each of its lit regions, of the resolution that all of the
// surface's particles ask for (texture_resolution.hpp), reconstructed by a spiral (spiral.hpp).
//
//   p(i,j) = sum of phi over the particles in texel (i,j) / its area                           (1)
//   V = |p_min - p_max| / p_max,  a texture where V >= eta                                     (2, 3)
//   resolution                                                                                 (4-7)
//   reconstruction                                                                             (8)
//   restriction: scan the reconstruction for a texel above a share of its maximum, flood-fill from it, make the
//     texture again for the bounding box alone; go on scanning                                 [GD01 3.3]
//
// The fixed values are the paper's. Departures: the spiral keeps flux; a region has the texels that (7) gives its own
// particles, and not as many as the whole surface, where ten particles would be ten specks; what lies outside all lit
// regions, and regions of too few particles to make a texture of, stay in a texture of the whole surface instead of
// being dropped.
// Cost: some two microseconds a texel, of which there are about as many as particles.
#include <optional>
#include <span>

#include "caustics/caustics.hpp"
#include "caustics/cell_light.hpp"

namespace deltalux::paper {

struct TextureThresholds {
  std::size_t leastParticles = 10;  // fewer are left to the mesh [GD01 3.1]
  double contrast = 0.5;            // eta; the paper names no value
  double variance = 1;              // epsilon [GD01 3.2]
  int radius = 8;                   // R in texels; the paper names no value
  double lit = 0.02;                // of the maximum, from which a texel is lit [GD01 3.3]: "between 1 and 5 %"
  bool restricted = true;           // to lit regions; false: one texture over the whole surface
};

/// V, the contrast of the histogram, in [0, 1]; 0 when it is black.
double contrast(const caustics::CellLight&);

/// Cells from `share` of the largest gray value on; none of them where all is black.
std::vector<char> litCells(const std::vector<Rgb>& E, double share);

/// Whether textures show these impacts on one side of a surface, or the mesh. [GD01 3.1]
bool deservesTextures(const Shape&, std::span<const particles::Impact>, const TextureThresholds& = {});

/// Textures for impacts on one side of a surface; nullopt where the mesh will do.
std::optional<caustics::SurfaceCaustics> makeTextures(const Shape&, std::span<const particles::Impact>,
                                                      const TextureThresholds& = {});

/// The two, by the thresholds above, for caustics/caustics.hpp.
caustics::TextureRule textureRule();

}  // namespace deltalux::paper
