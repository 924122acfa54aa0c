#pragma once
// Edges of light, as borders that smoothing does not cross. Round kernels must shrink at the edge of a caustic, and
// leave it noisy; with the edge known, light is averaged along it over many particles and not at all across.
//
// Every border gets an edge-stopping factor in (0, 1]: exp(-(d / kContrast)^2), d the jump of 2 sqrt E over it in units
// of its noise (a variance-stabilising scale [Anscombe48]), as in anisotropic diffusion [PM90]. What is compared:
//   blurredWalls  estimates from kernels of kParticles each, before anything is known: walls as thick as the kernels.
//   sharpWalls    a first reconstruction between those walls, cleaned of lone cells by a median: walls one border
//   thick.
// Cost: one scale space; for the second a pass over the borders.
#include <vector>

#include "caustics/scale_space.hpp"

namespace deltalux::caustics {

struct EdgeStopping {
  Borders stopping;
  Slots bandwidth;  // half the variance of a kernel that holds kParticles [unit^2]
};

/// `light`: gray E and density of squares, both of which the mean cell's area and the mean E were made 1 for.
EdgeStopping blurredWalls(const CellRaster&, const Channels& light);

/// `darkness`: differences below it do not matter [of E].
Borders sharpWalls(const CellRaster&, const Slots& E, double darkness);

}  // namespace deltalux::caustics
