#pragma once
// Mesh or texture? [GD01 3.1] The paper: a texture where the histogram's contrast V passes a threshold eta that the
// user sets. But V of a uniform light is anything up to 1, as the particles per texel have it. So the surface is asked
// instead whether what it received departs from what a coarse mesh could show
//   - by more than its noise: Pearson's chi-square over the cells, each with its own expectation, against the histogram
//     smoothed over an eighth of the surface;
//   - by more than matters: in the mean square, once the noise is taken off, by more than the target error of the light
//     that is there.
// Both follow from the particles and the target error. Cost: a pass over the cells, and one smoothing.
#include "caustics/cell_light.hpp"

namespace deltalux {

/// V, the contrast of the histogram; 0 when it is black.
double contrast(const CellLight&);

/// Sums over cells, of one chart or several.
struct Departure {
  double chiSquare = 0;  // of (observed - smooth)^2 / variance
  double cells = 0;      // its expectation, for noise alone
  double variance = 0;   // its variance, for noise alone
  double squares = 0;    // of the gray departure times area, less the noise's share [W2/m2]
  double flux = 0;       // gray [W]
  double area = 0;       // [unit^2]

  Departure& operator+=(const Departure&);
};

Departure departure(const CellGrid&, const CellLight&);

/// Of whole charts from their mean, for surfaces of several: gray flux and area of each.
Departure departureBetween(std::span<const double> flux, std::span<const double> area, double grain);

/// Whether a texture should show the particles' light. `background`: gray irradiance of all other light there.
bool deservesTexture(const Departure&, double error, double background);

}  // namespace deltalux
