#pragma once
// The scale of false colour beside the picture: what its colours stand for.
#include "drawing.hpp"

namespace deltalux::viewer {

struct LegendTick {
  double position = 0;  // along the scale, [0, 1]
  double value = 0;     // [lx or cd/m2]
};
/// Of each level of the scale; steps are all of one height.
std::vector<LegendTick> legendTicks(const FalseColour&);

/// Over the left edge of the picture, always when there is false colour and never otherwise. Sizes in ImGui's units.
void drawLegend(const FalseColour&, float pictureHeight, float bottom);

}  // namespace deltalux::viewer
