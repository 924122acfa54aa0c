#pragma once
// The same light through kernels of growing width: what reconstruction chooses from. Widths are standard deviations of
// Gaussians, by factors of sqrt 2. The narrow ones are made of the cells as they are; those beyond two cells on coarser
// ones (cell_pyramid.hpp), two widths a level, spread to the fine cells again and rounded off.
// Cost: about 15 passes over the borders, whatever the widest; making the coarser cells comes on top.
#include <vector>

#include "caustics/cell_light.hpp"
#include "caustics/cell_pyramid.hpp"

namespace deltalux {

/// One width: the light of all cells with it.
struct ScaleLevel {
  double width = 0;    // 0: the cells as they are [unit]
  double overlap = 0;  // integral of the kernel's square [1/unit^2]
  Channels light;      // gray E; density of squares (CellLight::squares)

  double E(std::size_t cell) const { return std::max(double(light[0][cell]), 0.0); }
  /// Times `overlap`, the variance of E.
  double squares(std::size_t cell) const { return std::max(double(light[1][cell]), 1e-300); }
  /// Gray flux of a particle here, weighted by its flux.
  double grain(std::size_t cell) const { return E(cell) > 0 ? squares(cell) / E(cell) : 0.0; }
  /// Particles that the kernel holds here, in equals.
  double count(std::size_t cell) const { return E(cell) * E(cell) / squares(cell) / overlap; }
};

/// Integral of the product of two Gaussian kernels at one place, over cells of `area`.
double kernelOverlap(double widthA, double widthB, double area);

class ScaleSpace {
 public:
  /// The cells as they are. `widest`: in cells. The pyramid must outlive this.
  ScaleSpace(CellPyramid&, const CellLight&, double widest);

  /// Adds the next level; false when there is none.
  bool widen();
  const std::vector<ScaleLevel>& levels() const { return levels_; }

 private:
  void makeNext();
  double roundedOff(std::size_t level) const;
  Channels onFinest(Channels, std::size_t level) const;

  CellPyramid& pyramid_;
  double area_, limit_;
  std::vector<ScaleLevel> levels_;
  std::vector<ScaleLevel> ready_;  // made, not yet shown; the next one last
  std::size_t level_ = 0;          // of the pyramid, that the next ones are made on
  double variance_ = 0;            // of the last one made, on its own cells
  Channels last_;                  // itself
};

}  // namespace deltalux
