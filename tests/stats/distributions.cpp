#include "stats/distributions.hpp"

#include <cmath>

namespace deltalux::test {

namespace {

constexpr double kTiny = 1e-300, kPrecision = 1e-14;

/// Lower regularised gamma by its power series, for x < a + 1. [DLMF 8.11.4]
double gammaSeries(double a, double x) {
  double term = 1.0 / a, sum = term;
  for (double n = a + 1; std::abs(term) > kPrecision * std::abs(sum); n += 1) sum += term *= x / n;
  return sum * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

/// Upper regularised gamma by its continued fraction, for x >= a + 1. [DLMF 8.9.2, evaluated by Lentz's method]
double gammaFraction(double a, double x) {
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b, d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c, c = std::abs(c) < kTiny ? kTiny : c;
    h *= d * c;
    if (std::abs(d * c - 1) < kPrecision) break;
  }
  return h * std::exp(-x + a * std::log(x) - std::lgamma(a));
}

/// Continued fraction of the incomplete beta function. [DLMF 8.17.22]
double betaFraction(double a, double b, double x) {
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double h = d;
  const auto step = [&](double numerator) {
    d = 1 + numerator * d, d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = 1 + numerator / c, c = std::abs(c) < kTiny ? kTiny : c;
    h *= c * d;
    return std::abs(c * d - 1) < kPrecision;
  };
  for (int m = 1; m < 100000; ++m) {
    step(m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)));
    if (step(-(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1)))) break;
  }
  return h;
}

double regularisedBeta(double a, double b, double x) {
  if (x <= 0) return 0;
  if (x >= 1) return 1;
  const double front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return front * betaFraction(a, b, x) / a;
  return 1 - front * betaFraction(b, a, 1 - x) / b;
}

}  // namespace

double chiSquareTail(double x, double degrees) {
  if (x <= 0) return 1;
  const double a = degrees / 2, h = x / 2;
  return h < a + 1 ? 1 - gammaSeries(a, h) : gammaFraction(a, h);
}

double studentTwoSidedTail(double t, double degrees) {
  return regularisedBeta(degrees / 2, 0.5, degrees / (degrees + t * t));
}

}  // namespace deltalux::test
