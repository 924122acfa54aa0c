#pragma once
// The same light through kernels of growing width: what reconstruction chooses from. Widths are standard deviations,
// each half an octave above the one before, which it is made of.
// Cost: the passes of HeatFlow up to the widest.
#include <vector>

#include "caustics/cell_light.hpp"
#include "caustics/heat_flow.hpp"

namespace deltalux::caustics {

/// One width: the light of all slots with it.
struct ScaleLevel {
  double width = 0;    // 0: the cells as they are [unit]
  double overlap = 0;  // integral of the kernel's square [1/unit^2]
  Channels light;      // gray E; density of squares (CellLight::squares): times `overlap`, the variance of E
};

/// Integral of the product of two Gaussian kernels at one place, over cells of `area`.
double kernelOverlap(double widthA, double widthB, double area);

class ScaleSpace {
 public:
  /// Level 0: the light of the cells as they are. `even` flows with a conductivity of 1, and must outlive this.
  ScaleSpace(const CellRaster&, const HeatFlow& even, Channels light);

  /// Adds the next level; false when there is none.
  bool widen();
  const std::vector<ScaleLevel>& levels() const { return levels_; }

 private:
  const HeatFlow& flow_;
  double area_, limit_;
  std::vector<ScaleLevel> levels_;
};

}  // namespace deltalux::caustics
