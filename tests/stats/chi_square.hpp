#pragma once
// Does a sampler draw from the density it claims? Pearson's chi-square over bins, neighbours pooled until each expects
// enough; and the same for directions and for points of the unit square.
#include <deltalux/math.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace deltalux::test {

struct ChiSquareResult {
  double pValue = 0;
  std::string message;  // what was compared, for a failure
};

/// Observed counts against expected ones (same sum up to `rest`, which both may miss alike).
ChiSquareResult chiSquare(const std::vector<double>& observed, const std::vector<double>& expected);

struct DirectionTest {
  Vec3 axis{0, 0, 1};        // bins are rings and sectors around it
  double concentration = 1;  // rings at (1 - cos) = 2 s^concentration: larger puts more rings near the axis
  int rings = 24, sectors = 24;
  int ringSubdivisions = 12, sectorSubdivisions = 12;  // of a bin, for the integral of the density
  int samples = 200000;
};

/// `draw(u)` makes a direction (or nothing) from three numbers; `density` [1/sr] may integrate to less than 1: the rest
/// is the chance of drawing nothing.
ChiSquareResult chiSquareDirections(const std::function<std::optional<Vec3>(const Vec3&)>& draw,
                                    const std::function<double(const Vec3&)>& density, const DirectionTest& = {});

}  // namespace deltalux::test
