#pragma once
// Mesh or texture? [GD01 3.1] The paper: a texture where the histogram's contrast V passes a threshold eta that the
// user sets. But V of a uniform light is anything up to 1, as the particles per texel have it. So the surface is asked
// instead whether what it received departs from what a coarse mesh could show
//   - by more than its noise: over the cells, squared differences from the histogram smoothed over an eighth of the
//     surface, each in units of its own variance and weighted by how well that tells, so that a few heavy particles,
//     next to which no other light can be made out, do not hide what there is elsewhere;
//   - by more than matters: in the mean square, once the noise is taken off, by more than the target error of the light
//     that is there.
// Both follow from the particles and the target error. Cost: a pass over the cells, and one smoothing.
#include "caustics/cell_light.hpp"

namespace deltalux::caustics {

/// What is expected in a cell of independent particles: gray flux, its variance (sum of squares) and fourth cumulant
/// (sum of fourth powers).
struct CellNoise {
  double expected = 0, variance = 0, fourth = 0;
};

/// Sums over cells, of one chart or several.
struct Departure {
  double excess = 0;     // of z^2 = (observed - smooth)^2 / variance over 1, weighted by 1 / its variance
  double precision = 0;  // the weights' sum: the variance of `excess`, for noise alone
  double squares = 0;    // of the gray departure times area, less the noise's share [W2/m2]
  double flux = 0;       // gray [W]
  double area = 0;       // [unit^2]

  /// Adds what a cell tells about noise.
  void add(double difference, const CellNoise&);

  Departure& operator+=(const Departure&);
};

Departure departure(const CellGrid&, const CellLight&);

/// Gray flux of a chart's particles, sums of its powers, and area.
struct PartLight {
  double flux = 0, squares = 0, fourths = 0, area = 0;
};
/// Of whole charts from their mean, for surfaces of several.
Departure departureBetween(std::span<const PartLight>);

/// Too few for a texture, whatever they show: so many equal particles would be as noisy as these. [GD01 3.1]
bool tooFew(double flux, double squaredFlux);

/// Whether a texture should show the particles' light. `background`: gray irradiance of all other light there.
bool deservesTexture(const Departure&, double error, double background);

}  // namespace deltalux::caustics
