#pragma once
// How wide must the kernel be at each cell? Kernels grow by half an octave, and the one is taken whose mean squared
// error is least: its variance, and the square of its bias, told by what differs from a kernel half as wide, less the
// variance of that difference (the comparison of estimates of [GL11], averaged over the kernel between the two); or the
// first whose own noise is within half the target error. Smooth light is averaged over many particles, the figure of a
// caustic over few; nothing is set by hand.
//
// The noise of a difference is that which the wider kernel's own estimate predicts, as a chi-square test does: where no
// particle fell, narrow kernels know no noise at all.
#include <vector>

#include "caustics/scale_space.hpp"

namespace deltalux::caustics {

struct BandwidthRule {
  double error = 0.05;  // relative noise that is small enough
  // Gray irradiance of other light, that differences and noise are compared with too [W/m2].
  double background = 0;  // on average
  double darkest = 0;     // where there is little of it: nowhere is noise larger than what is allowed there
};

struct Bandwidths {
  Slots conductivity;  // half the variance of the kernel of every slot [unit^2]: what HeatFlow takes for a time of 1
  Slots noise;         // that is left: variance of E
};

/// `light`: as for blurredWalls, and so is the rule. `even`: flows with a conductivity of 1, between walls.
Bandwidths chooseBandwidths(const CellRaster&, const HeatFlow& even, const Channels& light, const BandwidthRule&);

}  // namespace deltalux::caustics
