#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/radiance/calc_compiled.hpp"

namespace deltalux::io::radiance {

namespace {

double calcSqrt(double x) { return std::sqrt(x); }
double calcSin(double x) { return std::sin(x); }
double calcCos(double x) { return std::cos(x); }
double calcTan(double x) { return std::tan(x); }
double calcAsin(double x) { return std::asin(x); }
double calcAcos(double x) { return std::acos(x); }
double calcAtan(double x) { return std::atan(x); }
double calcAtan2(double y, double x) { return std::atan2(y, x); }
double calcFloor(double x) { return std::floor(x); }
double calcCeil(double x) { return std::ceil(x); }
double calcExp(double x) { return std::exp(x); }
double calcLog(double x) { return std::log(x); }
double calcLog10(double x) { return std::log10(x); }
double calcErf(double x) { return std::erf(x); }
double calcErfc(double x) { return std::erfc(x); }
double calcMin(const double* x, int n) { return *std::min_element(x, x + n); }
double calcMax(const double* x, int n) { return *std::max_element(x, x + n); }

/// select(0, ...) counts the choices, select(i, ...) is the i-th.
double calcSelect(const double* x, int n) {
  const double choice = std::floor(x[0] + 0.5);
  if (choice == 0) return n - 1;
  return choice >= 1 && choice <= n - 1 ? x[static_cast<int>(choice)] : std::nan("");
}

/// Values p0, p1 and slopes r0, r1 at 0 and 1.
double hermite(double p0, double p1, double r0, double r1, double t) {
  const double t2 = t * t, t3 = t2 * t;
  return p0 * (2 * t3 - 3 * t2 + 1) + p1 * (3 * t2 - 2 * t3) + r0 * (t3 - 2 * t2 + t) + r1 * (t3 - t2);
}

/// Bernstein form.
double bezier(double p0, double p1, double p2, double p3, double t) {
  const double s = 1 - t;
  return p0 * s * s * s + 3 * p1 * t * s * s + 3 * p2 * t * t * s + p3 * t * t * t;
}

/// Uniform cubic.
double bspline(double p0, double p1, double p2, double p3, double t) {
  const double s = 1 - t, t2 = t * t, t3 = t2 * t;
  return (p0 * s * s * s + p1 * (3 * t3 - 6 * t2 + 4) + p2 * (-3 * t3 + 3 * t2 + 3 * t + 1) + p3 * t3) / 6;
}

constexpr std::array<std::pair<std::string_view, int>, 21> kLibrary{{
    {"sqrt", 1},  {"sin", 1},   {"cos", 1},  {"tan", 1},     {"asin", 1},    {"acos", 1},   {"atan", 1},
    {"atan2", 2}, {"floor", 1}, {"ceil", 1}, {"exp", 1},     {"log", 1},     {"log10", 1},  {"erf", 1},
    {"erfc", 1},  {"min", -1},  {"max", -1}, {"select", -1}, {"hermite", 5}, {"bezier", 5}, {"bspline", 5},
}};

}  // namespace

std::optional<int> libraryArity(std::string_view name) {
  const auto* const found =
      std::find_if(kLibrary.begin(), kLibrary.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == kLibrary.end()) return std::nullopt;
  return found->second;
}

mu::Parser calcParser() {
  mu::Parser parser;
  parser.ClearFun();
  parser.DefineFun("sqrt", calcSqrt);
  parser.DefineFun("sin", calcSin);
  parser.DefineFun("cos", calcCos);
  parser.DefineFun("tan", calcTan);
  parser.DefineFun("asin", calcAsin);
  parser.DefineFun("acos", calcAcos);
  parser.DefineFun("atan", calcAtan);
  parser.DefineFun("atan2", calcAtan2);
  parser.DefineFun("floor", calcFloor);
  parser.DefineFun("ceil", calcCeil);
  parser.DefineFun("exp", calcExp);
  parser.DefineFun("log", calcLog);
  parser.DefineFun("log10", calcLog10);
  parser.DefineFun("erf", calcErf);
  parser.DefineFun("erfc", calcErfc);
  parser.DefineFun("min", calcMin);
  parser.DefineFun("max", calcMax);
  parser.DefineFun("select", calcSelect);
  parser.DefineFun("hermite", hermite);
  parser.DefineFun("bezier", bezier);
  parser.DefineFun("bspline", bspline);
  return parser;
}

}  // namespace deltalux::io::radiance
