#pragma once
// What particles left in the cells of a grid: the histogram p(i,j) of [GD01 (1)], per cell's true area, and what tells
// how noisy it is.
#include <deltalux/units.hpp>
#include <span>
#include <vector>

#include "caustics/cell_grid.hpp"

namespace deltalux::caustics {

/// An impact on a chart.
struct ChartImpact {
  Vec2 st{0};
  Rgb flux{0.0f};  // [W]
};

struct CellLight {
  std::vector<Rgb> E;           // sum of flux / area [W/m2]
  std::vector<float> gray;      // of E
  std::vector<float> squares;   // sum of gray flux squared / area: times a kernel's own square, the variance of gray E
  std::vector<double> fourths;  // sum of its fourth power / area
  RgbSum flux{0.0};             // of all particles
  double squaredFlux = 0;       // sum of gray flux squared
  std::size_t particles = 0;

  /// Mean gray flux of a particle, each weighted by its flux: the grain of the noise.
  double grain() const { return deltalux::gray(flux) > 0 ? squaredFlux / deltalux::gray(flux) : 0.0; }
  /// As many equal particles would be as noisy.
  double effectiveParticles() const {
    return squaredFlux > 0 ? deltalux::gray(flux) * deltalux::gray(flux) / squaredFlux : 0.0;
  }
};

CellLight collect(const CellGrid&, std::span<const ChartImpact>);

/// Mean gray irradiance where the particles are: the integral of E^2 over that of E, without the part that each
/// particle adds to its own cell. Finer grids see sharper peaks; noise alone does not raise it.
double typicalIrradiance(const CellGrid&, const CellLight&);
/// The same from gray flux, sums of its squares and areas.
double typicalIrradiance(std::span<const double> flux, std::span<const double> squares, std::span<const float> areas);

/// The value that half of the weight lies below. Neither are negative.
double weightedMedian(std::span<const float> values, std::span<const float> weights);

/// The gray irradiance below which half of the flux lies: what most of the light looks like, whatever its peaks.
double medianOfFlux(std::span<const float> areas, std::span<const float> E);

std::vector<float> grayOf(const std::vector<Rgb>& E);

}  // namespace deltalux::caustics
