#pragma once
// Functions of direction as tables.
#include <deltalux/direction_table.hpp>
#include <functional>

namespace deltalux::io::radiance {

struct Tabulated {
  DirectionTable table;  // relative to `peak`
  double peak = 0;       // 0: dark everywhere
  double error = 0;      // left between the angles, relative to the mean
  bool constant = false;
};

/// Samples `f` over unit directions in the table's frame, what is negative as 0. The angles are halved until the values
/// between them are interpolated to a thousandth of the mean, at most to half a degree, or an eighth where nothing
/// depends on azimuth; never when it is not to be `fine`: 2 degrees. Throws whatever `f` throws; values that are not
/// finite are an exception of `notFinite`. Cost: 10^4 to 4 10^5 evaluations.
Tabulated tabulate(const std::function<double(const Vec3&)>& f, const std::function<void()>& notFinite, bool fine);

}  // namespace deltalux::io::radiance
