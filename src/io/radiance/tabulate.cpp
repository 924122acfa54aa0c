#include "io/radiance/tabulate.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "base/unit_circle.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kAlike = 1e-7;  // differences that are none, relative to the peak [rounding]
constexpr std::size_t kMostSteps = 360,
                      kMostStepsAlone = 1440;  // alone: without azimuth; what is finer is reported [limit]

using Function = std::function<double(const Vec3&)>;

Vec3 direction(double polar, double turn) {
  const double theta = kPi * polar;
  return Vec3(std::sin(theta) * onUnitCircle(turn), std::cos(theta));
}

struct Range {
  double low = kInfinity, high = 0;

  void extend(double x) { low = std::min(low, x), high = std::max(high, x); }
};

/// Whether the values depend on azimuth, by a sample of irregular directions; `all` gets their range.
bool dependsOnAzimuth(const Function& f, Range& all) {
  double widest = 0;
  for (int i = 0; i < deltalux::tuning::kPilots; ++i) {
    Range ring;
    for (std::size_t k = 0; k < std::size_t(deltalux::tuning::kPolarAngles); ++k)
      ring.extend(f(direction((i + 0.37) / deltalux::tuning::kPilots,
                              (double(k) + 0.21 * i) / double(deltalux::tuning::kPolarAngles))));
    widest = std::max(widest, ring.high - ring.low);
    all.extend(ring.low), all.extend(ring.high);
  }
  return widest > kAlike * all.high;
}

std::vector<double> sample(const Function& f, std::size_t rows, std::size_t columns) {
  std::vector<double> values;
  values.reserve(rows * columns);
  for (std::size_t row = 0; row < rows; ++row) {
    const double polar = double(row) / double(rows - 1);
    const bool pole = row == 0 || row + 1 == rows;
    for (std::size_t column = 0; column < columns; ++column)
      values.push_back(pole && column > 0 ? values.back() : f(direction(polar, double(column) / double(columns))));
  }
  return values;
}

/// Mean difference in the middle of the cells, relative to the mean.
double errorBetween(const Function& f, const DirectionTable& table, double peak) {
  double error = 0, mean = 0;
  for (std::size_t row = 0; row + 1 < table.rows; ++row) {
    const double polar = (double(row) + 0.5) / double(table.rows - 1), weight = std::sin(kPi * polar);
    for (std::size_t column = 0; column < table.columns; ++column) {
      const Vec3 w = direction(polar, (double(column) + 0.5) / double(table.columns));
      const double value = f(w);
      error += weight * std::abs(value - peak * valueAt(table, w)), mean += weight * value;
    }
  }
  return mean > 0 ? error / mean : 0;
}

}  // namespace

Tabulated tabulate(const Function& raw, const std::function<void()>& notFinite, bool fine) {
  const Function f = [&](const Vec3& w) {
    const double value = raw(w);
    if (!std::isfinite(value)) notFinite();
    return std::max(0.0, value);
  };
  Range all;
  const bool alone = !dependsOnAzimuth(f, all);
  for (std::size_t steps = deltalux::tuning::kPolarAngles;; steps *= 2) {
    const std::size_t rows = steps + 1, columns = alone ? 1 : 2 * steps;
    const std::vector<double> values = sample(f, rows, columns);
    for (const double value : values) all.extend(value);
    Tabulated result{{rows, columns, {}}, all.high, 0, all.high - all.low <= kAlike * all.high};
    for (const double value : values)
      result.table.values.push_back(all.high > 0 ? static_cast<float>(value / all.high) : 0.0f);
    if (result.constant) return result;
    result.error = errorBetween(f, result.table, all.high);
    if (!fine || result.error <= deltalux::tuning::kNegligible || steps >= (alone ? kMostStepsAlone : kMostSteps))
      return result;
  }
}

}  // namespace deltalux::io::radiance
