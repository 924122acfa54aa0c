#pragma once
// A non-negative function of direction, tabulated.
#include <cstddef>
#include <deltalux/math.hpp>
#include <vector>

namespace deltalux {

/// values[row * columns + column] over polar angles from +z, row / (rows - 1) of 180 degrees, and azimuths from +x
/// towards +y, column / columns of 360 degrees; a single column means that nothing depends on azimuth.
struct DirectionTable {
  std::size_t rows = 0, columns = 0;  // at least 2 and 1
  std::vector<float> values;
};

/// The value towards the unit direction `w` in the table's frame, bilinear between the angles.
double valueAt(const DirectionTable&, const Vec3& w);
/// Integral over all directions [value * sr], of the values as valueAt() interpolates them along the polar angle.
double integral(const DirectionTable&);

}  // namespace deltalux
