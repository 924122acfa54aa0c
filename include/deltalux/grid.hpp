#pragma once
// Measuring grids as EN 12464-1 has them, and what such standards ask of the illuminances there.
#include <deltalux/probe.hpp>
#include <deltalux/scene.hpp>
#include <span>
#include <vector>

namespace deltalux {

/// A rectangle where light is wanted, measured on the side that cross(u, v) points to.
struct GridArea {
  Vec3 corner{0}, u{1, 0, 0}, v{0, 1, 0};  // its sides are at right angles [scene units]
};

struct GridSettings {
  double border = 0.5;  // left out along the rim, but no more than 15 % of the shorter side [m]
  double spacing = 0;   // of points at most [m]; 0: gridSpacing(), and the nearest whole number of cells
  double height = 0;    // of the points above the area [m]
};

struct MeasuringGrid {
  GridArea area;                   // that the cells cover: without the border
  int columns = 0, rows = 0;       // along u, along v
  std::vector<ProbePoint> points;  // in the middles of cells
  std::vector<std::size_t> cells;  // by point, ascending: row * columns + column. Cells off the surface have no point
};

/// The greatest distance of points for an area of such sides: p = 0.2 * 5^log10(d), at most 10 m; d is the longer side,
/// or the shorter where the other is twice as long or more. [EN12464]
double gridSpacing(double side, double otherSide);

/// The grid of an area. Precondition: sides are at right angles and not 0. Throws InputError beyond a million points.
MeasuringGrid gridOf(const GridArea&, double metresPerUnit, const GridSettings& = {});

/// The grid of an object's largest level polygon or disc, from above, or, where none of them is level, of the largest,
/// from its front: of the rectangle about it along its longest edge. Throws InputError where it has neither.
MeasuringGrid gridOn(const Scene&, std::string_view object, const GridSettings& = {});

/// The same on a polygon, from above where it is level, else from its front. Throws InputError where none of the points
/// lies on it.
MeasuringGrid gridOn(const Polygon&, const Vec3& up, double metresPerUnit, const GridSettings& = {});

/// Of illuminances at points [lux]; they must not be none.
struct GridStatistics {
  double mean = 0, least = 0, most = 0;

  double uniformity() const { return mean > 0 ? least / mean : 0; }  // U0
  double diversity() const { return most > 0 ? least / most : 0; }   // Ud
};
GridStatistics statisticsOf(std::span<const double> lux);

/// Points whose mean illuminance is the cylindrical illuminance at a point: upright, in directions all round.
std::vector<ProbePoint> cylinderAt(const ProbePoint&, const Vec3& up);

}  // namespace deltalux
