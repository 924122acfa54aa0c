#pragma once
// The scale of false colour: what its colours stand for, in the colours of the library's own false-colour pictures.
#include "drawing.hpp"

namespace deltalux::viewer {

struct LegendTick {
  double position = 0;  // along the scale, [0, 1]
  double value = 0;     // [lx or cd/m2]
};
/// Ticks of a scale: its steps; else 1, 2 and 5 and their multiples by ten, or ten equal parts where it is linear.
std::vector<LegendTick> legendTicks(const FalseColour&);

/// Over the left edge of the picture, always when there is false colour and never otherwise. Sizes in ImGui's units.
void drawLegend(const FalseColour&, float pictureHeight, float bottom);

}  // namespace deltalux::viewer
