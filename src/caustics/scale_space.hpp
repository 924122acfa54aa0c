#pragma once
// The same light through kernels of growing width: what reconstruction chooses from. Widths are standard deviations of
// Gaussians, by factors of sqrt 2, each level made from the one before it.
// Cost: the widest kernel's radius in cells times about 15 passes over the borders.
#include <vector>

#include "caustics/cell_light.hpp"
#include "caustics/heat_flow.hpp"

namespace deltalux {

/// One width: the light of all cells with it.
struct ScaleLevel {
  double width = 0;              // 0: the cells as they are [unit]
  double overlap = 0;            // integral of the kernel's square [1/unit^2]
  std::vector<glm::vec2> light;  // gray E; density of squares (CellLight::squares)

  double E(std::size_t cell) const { return std::max(double(light[cell].x), 0.0); }
  /// Times `overlap`, the variance of E.
  double squares(std::size_t cell) const { return std::max(double(light[cell].y), 1e-300); }
  /// Gray flux of a particle here, weighted by its flux.
  double grain(std::size_t cell) const { return E(cell) > 0 ? squares(cell) / E(cell) : 0.0; }
  /// Particles that the kernel holds here, in equals.
  double count(std::size_t cell) const { return E(cell) * E(cell) / squares(cell) / overlap; }
};

/// Integral of the product of two Gaussian kernels at one place, over cells of `area`.
double kernelOverlap(double widthA, double widthB, double area);

class ScaleSpace {
 public:
  /// The cells as they are. `widest`: in cells. The grid must outlive this.
  ScaleSpace(const CellGrid&, const CellLight&, Openness, double widest);

  /// Adds the next level; false when there is none.
  bool widen();
  const std::vector<ScaleLevel>& levels() const { return levels_; }

 private:
  HeatFlow flow_;
  double area_, limit_;
  std::vector<ScaleLevel> levels_;
};

}  // namespace deltalux
