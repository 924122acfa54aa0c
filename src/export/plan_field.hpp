#pragma once
// Illuminances of a grid as a field: between its points, with lines of equal illuminance and a scale of colours.
#include <deltalux/plan.hpp>

namespace deltalux::exporting {

/// Illuminance between the points of a grid: linear, and constant beyond the outermost.
class PlanField {
 public:
  PlanField(const MeasuringGrid&, std::span<const double> lux);
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// -1: no point.
  double cell(int column, int row) const {
    return lux_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column)];
  }
  /// At x, y in cells; -1 off the surface.
  double at(double x, double y) const;

 private:
  int columns_, rows_;
  std::vector<double> lux_;
};

/// Round illuminances between the least and the most.
std::vector<double> levelsOf(const GridStatistics&);

constexpr double kFewDecades = 0.15, kLabelled = 0.9;  // of scales of colours [shown]
/// From a round number above the most to a little below the least, over `decades` at least.
FalseColorSettings coloursOf(const GridStatistics&, double decades);

/// A picture of illuminances, its rows downwards.
template <class Lux>
Image imageOfLux(int width, int height, const Lux& lux) {
  Image image;
  image.width = width, image.height = height, image.luminousEfficacy = kLuminousEfficacy;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double E = lux(x, y);
      image.pixels.emplace_back(static_cast<float>(E < 0 ? -1.0 : E / kLuminousEfficacy));
    }
  return image;
}

struct Segment {
  Vec2 a, b;  // in cells
};

/// Where the light between the middles of cells is `level`: marching squares, two triangles a square.
std::vector<Segment> lineAt(const PlanField&, double level);

}  // namespace deltalux::exporting
