#pragma once
// Illuminances of a measuring grid as a plan: false colours, lines of equal illuminance, values.
#include <deltalux/grid.hpp>
#include <deltalux/image.hpp>
#include <filesystem>
#include <string>

namespace deltalux {

/// Illuminances at a grid's points [lux], by point.
struct Plan {
  const MeasuringGrid& grid;
  std::span<const double> lux;
  std::string title;
  double metresPerUnit = 1;
};

/// As SVG: cells in false colour, linear between points; lines of equal illuminance at round values; the points'
/// values; a legend, and the sides in metres.
std::string planSvg(const Plan&);
/// As a picture for a screen: the same without title and values, with falseColor()'s legend.
DisplayImage planImage(const Plan&);

/// Writes .svg or .png, by the file's name, atomically. Throws OutputError.
void savePlan(const std::filesystem::path&, const Plan&);

}  // namespace deltalux
