#pragma once
// Heat flow of conductivities that differ from cell to cell, over kernels many cells wide: what a conductivity has
// beyond a kernel of two or three cells flows over coarser cells (cell_pyramid.hpp), between the two halves of what the
// fine cells keep: before it so that coarse cells see no noise between them, after it so that they leave no steps. Flux
// is kept to rounding.
// Cost: about 25 passes over the borders, whatever the widest kernel; HeatFlow alone needs 7 a cell of its radius.
// Noise is 6 % above that of HeatFlow with the same conductivities, sharp edges are the same.
#include "caustics/cell_pyramid.hpp"

namespace deltalux {

/// E after a time of 1. `conductivity` of the finest cells, as HeatFlow's.
void flowWidely(CellPyramid&, Channels& E, std::vector<float> conductivity);

}  // namespace deltalux
