#include "io/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace deltalux::io {

namespace {

constexpr double kFirstSeen = 380, kLastSeen = 780, kSeenStep = 5;  // nm, as in tables of the CIE [defined]
constexpr double kWhiteKelvin = 6504;                               // correlated colour temperature of D65 [defined]
constexpr double kSecondRadiation = 1.438776877e7;                  // h c / k [nm K] [defined]

/// CIE's matching functions of 1931. [WSS13 (4)]
glm::dvec3 matching(double wavelength) {
  const auto lobe = [&](double centre, double below, double above) {
    const double t = (wavelength - centre) / (wavelength < centre ? below : above);
    return std::exp(-0.5 * t * t);
  };
  return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
          0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
          1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}

/// Up to a factor; finite for every temperature above 0.
double planck(double wavelength, double kelvin) {
  const double x = kSecondRadiation / (wavelength * kelvin), most = kSecondRadiation / (kLastSeen * kelvin);
  // Relative to the far end, where little is seen: neither grows beyond the numbers.
  return std::exp(std::min(most - x, 0.0)) * std::pow(kLastSeen / wavelength, 5) * std::expm1(-most) / std::expm1(-x);
}

/// Linear sRGB, times what white has.
glm::dvec3 integrated(const std::function<double(double)>& power) {
  // Columns of XYZ's share in red, green and blue. [IEC 61966-2-1]
  const glm::dmat3 toRgb({3.2406, -0.9689, 0.0557}, {-1.5372, 1.8758, -0.2040}, {-0.4986, 0.0415, 1.0570});
  glm::dvec3 sum(0);
  for (double at = kFirstSeen; at <= kLastSeen; at += kSeenStep) sum += power(at) * matching(at);
  return toRgb * sum;
}

glm::dvec3 relative(const std::function<double(double)>& power) {
  static const glm::dvec3 white = integrated([](double at) { return planck(at, kWhiteKelvin); });
  return glm::max(integrated(power) / white, glm::dvec3(0));
}

double valueAt(const Spectrum& spectrum, double wavelength) {
  const auto next = std::ranges::lower_bound(spectrum, wavelength, {}, &Spectrum::value_type::first);
  if (next == spectrum.end()) return 0;
  if (next->first == wavelength) return next->second;
  if (next == spectrum.begin()) return 0;
  const auto before = next - 1;
  return std::lerp(before->second, next->second, (wavelength - before->first) / (next->first - before->first));
}

Rgb ofLuminanceOne(const glm::dvec3& light) {
  const double luminance = gray(light);
  return luminance > 0 && std::isfinite(luminance) ? Rgb(light / luminance) : Rgb(0.0f);
}

}  // namespace

Rgb colourOfReflectance(const Spectrum& spectrum) {
  return Rgb(relative([&](double at) { return valueAt(spectrum, at) * planck(at, kWhiteKelvin); }));
}

Rgb colourOfLight(const Spectrum& spectrum) {
  return ofLuminanceOne(relative([&](double at) { return valueAt(spectrum, at); }));
}

Rgb colourOfBlackBody(double kelvin) {
  return ofLuminanceOne(relative([&](double at) { return planck(at, kelvin); }));
}

}  // namespace deltalux::io
