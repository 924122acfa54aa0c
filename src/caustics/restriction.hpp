#pragma once
// Textures only where they are needed [GD01 3.3]: scan for a lit texel, flood-fill from it, take the bounding box of
// what was filled, clear it and go on scanning. Boxes that overlap become one.
//
// The paper calls lit what exceeds 1 to 5 % of the maximum; faint, even light of particles over a wall then makes the
// whole wall one region. Here a texel counts when it differs from even light (the median over the area) by more than
// the target error of the light where the particles are. What lies outside all regions is smooth, and stays in one
// coarse texture of the whole surface, so that no flux is dropped.
#include <vector>

#include "caustics/cell_light.hpp"

namespace deltalux::caustics {

/// Texels [x0, x1) x [y0, y1) of a grid; on a closed grid x1 may exceed its width.
struct TexelBox {
  int x0, y0, x1, y1;
  friend bool operator==(const TexelBox&, const TexelBox&) = default;
};

/// Whether the box holds the texel, on a grid `width` wide that may be closed.
bool holds(const TexelBox&, int x, int y, int width);

/// Cells that differ from the median over the area by more than `difference` [W/m2].
std::vector<char> cellsOffMedian(const CellGrid&, const std::vector<float>& E, double difference);

/// Disjoint boxes around all patches of marked cells, widened by `margin` texels.
std::vector<TexelBox> markedBoxes(const CellGrid&, const std::vector<char>& marked, int margin);

/// The part of the grid's region under a box.
Region regionOf(const CellGrid&, const TexelBox&);

}  // namespace deltalux::caustics
