#pragma once
// False colour: where a value stands on the scale, and the colour of that place. The one source of it for what is drawn
// and for the legend. Colours are those of the library's falseColor(): cubehelix [Green11], whose brightness rises with
// the value.
#include <vector>

#include "drawing.hpp"

namespace deltalux::viewer {

/// Whether the scale has steps instead of a run of colours.
bool hasBands(const FalseColour&);
/// Values at which isolines run and a legend has its marks, ascending: the bands where they are used, otherwise 1, 2, 5
/// and their multiples by ten on the logarithmic scale, tenths of the top on the linear one.
std::vector<double> scaleLevels(const FalseColour&);
/// Place of a value on the scale, 0 at its bottom to 1 at its top; with bands the same for all values of a step.
double scalePosition(const FalseColour&, double value);
/// Colour of a place, as the screen shows it: no sRGB curve follows. Never pure black or white.
glm::vec3 rampColour(double position);
/// Colour of a value [lux or cd/m2].
glm::vec3 falseColourRamp(const FalseColour&, double value);

}  // namespace deltalux::viewer
