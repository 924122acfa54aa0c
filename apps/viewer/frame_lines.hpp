#pragma once
// Lines that explain a frame: the ways light came, meters, the rectangle of meters.
#include "controller.hpp"

namespace deltalux::viewer {

/// From the lamps that bring most, and along the paths of particles with `paths`; the strongest is the brightest.
void addExplanation(std::vector<Line>&, const Scene&, const ProbePoint&, const Contributions&, bool paths);
/// A stem along the normal and a cross on the surface, `size` long [scene units].
void addMeter(std::vector<Line>&, const ProbePoint&, double size);
void addField(std::vector<Line>&, const MeterField&);

}  // namespace deltalux::viewer
