#include <algorithm>
#include <cmath>
#include <deltalux/direction_table.hpp>

namespace deltalux {

namespace {

/// The step that holds `x` of `steps`, and where in it.
struct Step {
  std::size_t index;
  double fraction;
};

Step stepAt(double x, std::size_t steps) {
  const double last = static_cast<double>(steps) - 1;
  const double index = std::clamp(std::floor(x), 0.0, last);
  return {static_cast<std::size_t>(index), std::clamp(x - index, 0.0, 1.0)};
}

}  // namespace

double valueAt(const DirectionTable& table, const Vec3& w) {
  const double sine = std::hypot(w.x, w.y);  // acos(z) loses half of the digits near the poles
  const auto [row, down] = stepAt(std::atan2(sine, w.z) / kPi * static_cast<double>(table.rows - 1), table.rows - 1);
  const float* const upper = table.values.data() + row * table.columns;
  const float* const lower = upper + table.columns;
  if (table.columns == 1) return (1 - down) * upper[0] + down * lower[0];
  const double turn = std::atan2(w.y, w.x) / (2 * kPi);
  const auto [column, along] = stepAt((turn < 0 ? turn + 1 : turn) * static_cast<double>(table.columns), table.columns);
  const std::size_t next = column + 1 < table.columns ? column + 1 : 0;
  return (1 - down) * ((1 - along) * upper[column] + along * upper[next]) +
         down * ((1 - along) * lower[column] + along * lower[next]);
}

double integral(const DirectionTable& table) {
  const double step = kPi / static_cast<double>(table.rows - 1);
  double sum = 0;
  for (std::size_t row = 0; row + 1 < table.rows; ++row) {
    double upper = 0, lower = 0;
    for (std::size_t column = 0; column < table.columns; ++column) {
      upper += table.values[row * table.columns + column];
      lower += table.values[(row + 1) * table.columns + column];
    }
    // Integral of f(t) sin t, f linear between two rows.
    const double t0 = static_cast<double>(row) * step, t1 = t0 + step;
    sum += upper * (std::cos(t0) - std::cos(t1)) +
           (lower - upper) / step * (std::sin(t1) - std::sin(t0) - step * std::cos(t1));
  }
  return sum * 2 * kPi / static_cast<double>(table.columns);
}

}  // namespace deltalux
