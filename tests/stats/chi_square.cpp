#include "stats/chi_square.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/random.hpp"
#include "stats/distributions.hpp"

namespace deltalux::test {

ChiSquareResult chiSquare(const std::vector<double>& observed, const std::vector<double>& expected) {
  constexpr double kPool = 10;
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  const double drawn = std::accumulate(observed.begin(), observed.end(), 0.0);
  double statistic = 0, pooledObserved = 0, pooledExpected = 0, impossible = 0;
  int cells = 0;
  for (std::size_t i : order) {
    // A bin cut by a horizon may be missed by the quadrature: a handful of samples there is no offence.
    if (expected[i] <= 0) impossible += observed[i];
    if (impossible > 1e-4 * drawn) return {0, fmt::format("{} samples where the density is zero", impossible)};
    pooledObserved += observed[i], pooledExpected += expected[i];
    if (pooledExpected < kPool) continue;
    const double d = pooledObserved - pooledExpected;
    statistic += d * d / pooledExpected, ++cells;
    pooledObserved = pooledExpected = 0;
  }
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  return {chiSquareTail(statistic, std::max(1, cells - 1)),
          fmt::format("chi^2 = {:.1f} with {} cells, {:.1f} expected samples, {:.0f} observed", statistic, cells, total,
                      drawn)};
}

ChiSquareResult chiSquareDirections(const std::function<std::optional<Vec3>(const Vec3&)>& draw,
                                    const std::function<double(const Vec3&)>& density, const DirectionTest& test) {
  const Frame frame(test.axis);
  const int bins = test.rings * test.sectors;
  std::vector<double> observed(bins + 1, 0), expected(bins + 1, 0);
  Rng rng(20011);
  for (int i = 0; i < test.samples; ++i) {
    const auto w = draw({rng.uniform(), rng.uniform(), rng.uniform()});
    if (!w) {
      ++observed[bins];
      continue;
    }
    const Vec3 local = frame.toLocal(*w);
    // 1 - cos = 2 sin^2(theta / 2) keeps its digits near the axis.
    const double oneMinusCos = 0.5 * glm::dot(*w - test.axis, *w - test.axis);
    const double s = std::pow(std::clamp(oneMinusCos / 2, 0.0, 1.0), 1 / test.concentration);
    const double phi = std::atan2(local.y, local.x) / (2 * kPi) + 0.5;
    const int ring = std::min(test.rings - 1, static_cast<int>(s * test.rings));
    const int sector = std::min(test.sectors - 1, static_cast<int>(phi * test.sectors));
    ++observed[ring * test.sectors + sector];
  }
  const int n = test.ringSubdivisions, m = test.sectorSubdivisions;
  double sum = 0;
  for (int bin = 0; bin < bins; ++bin) {
    double integral = 0;
    for (int k = 0; k < n * m; ++k) {
      const double s = (bin / test.sectors + (k / m + 0.5) / n) / test.rings;
      const double phi = ((bin % test.sectors + (k % m + 0.5) / m) / test.sectors - 0.5) * 2 * kPi;
      const double h = std::pow(s, test.concentration);  // (1 - cos) / 2
      const double sinTheta = 2 * std::sqrt(h * (1 - h));
      const Vec3 w = frame.toWorld({sinTheta * std::cos(phi), sinTheta * std::sin(phi), 1 - 2 * h});
      integral += density(w) * 2 * test.concentration * std::pow(s, test.concentration - 1);
    }
    expected[bin] = integral / (n * m) * (1.0 / test.rings) * (2 * kPi / test.sectors) * test.samples;
    sum += expected[bin];
  }
  expected[bins] = std::max(0.0, test.samples - sum);
  if (sum > test.samples * (1 + 1e-3)) return {0, fmt::format("the density integrates to {}", sum / test.samples)};
  // What the quadrature leaves over counts as "nothing drawn" only when it is more than its own error.
  if (expected[bins] < 1e-4 * test.samples && observed[bins] == 0) expected[bins] = 0;
  return chiSquare(observed, expected);
}

}  // namespace deltalux::test
