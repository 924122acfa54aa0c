// The two sums over sources.
#include <algorithm>
#include <cmath>

#include "glare/sight_frame.hpp"

namespace deltalux {

namespace {
constexpr double kDim = 1000;  // [lux] below it people are disturbed less than DGP says [Wienold09] [defined]
}

double unifiedGlareRating(std::span<const GlareSource> sources, double background) {
  double sum = 0;
  for (const GlareSource& s : sources) sum += glare::disturbance(s);
  if (!(sum > 0)) return -std::numeric_limits<double>::infinity();
  return 8 * std::log10(0.25 / background * sum);  // [CIE 117 (4)]
}

double daylightGlareProbability(std::span<const GlareSource> sources, double Ev) {
  if (!(Ev > 0)) return 0;
  double sum = 0;
  for (const GlareSource& s : sources) sum += glare::disturbance(s);
  double dgp = 5.87e-5 * Ev + 9.18e-2 * std::log10(1 + sum / std::pow(Ev, 1.87)) + 0.16;  // [WC06]
  if (Ev < kDim) {
    const double e = std::exp(0.024 * Ev - 4);
    dgp *= e / (1 + e);  // [Wienold09]
  }
  return std::min(dgp, 1.0);
}

}  // namespace deltalux
