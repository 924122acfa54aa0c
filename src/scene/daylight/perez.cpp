#include "scene/daylight/perez.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/math.hpp>

#include "base/tuning.hpp"

namespace deltalux::scene {

namespace {

constexpr std::size_t kBins = 8;                                                         // [defined]
constexpr std::array<double, kBins - 1> kBounds{1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};  // of clearness [defined]
constexpr double kClearest = 12.01, kDarkest = 0.01, kBrightest = 0.6;                   // [defined]
constexpr double kKappa = 1.041;  // of the sun's zenith angle in the clearness, radians [defined]

std::size_t binOf(double clearness) {
  return static_cast<std::size_t>(std::upper_bound(kBounds.begin(), kBounds.end(), clearness) - kBounds.begin());
}

using Four = std::array<double, 4>;

// [PSM93, table 1], a to e of each bin.
constexpr std::array<std::array<Four, 5>, kBins> kLuminance{{
    {{{1.3525, -0.2576, -0.2690, -1.4366},
      {-0.7670, 0.0007, 1.2734, -0.1233},
      {2.8000, 0.6004, 1.2375, 1.0000},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {{{-1.2219, -0.7730, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.9750, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.1080},
      {0.2624, 0.0672, -0.2190, -0.4285}}},
    {{{-1.1000, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5000, 1.1766},
      {24.7219, -13.0812, -37.7000, 34.8438},
      {-5.0000, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {{{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3000, -62.2500, 52.0781},
      {-3.5000, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {{{-0.6000, -0.3566, -2.5000, 2.3250},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21.0000, -4.7656, -21.5906, 7.2492},
      {-3.5000, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {{{-1.0156, -0.3670, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.8500, 3.3750},
      {14.0000, -0.9999, -7.1406, 7.5469},
      {-3.4000, -0.1078, -1.0750, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {{{-1.0000, 0.0211, 0.5025, -0.5119},
      {-0.3000, 0.1922, 0.7023, -1.6317},
      {19.0000, -5.0000, 1.2438, -1.9094},
      {-4.0000, 0.0250, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {{{-1.0500, 0.0289, 0.4260, 0.3590},
      {-0.3250, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5000, -46.1148, 55.3750},
      {-7.2312, 0.4050, 13.3500, 0.6234},
      {1.5000, -0.6426, 1.8564, 0.5636}}},
}};  // [defined]

// [PIS90, table 4]
constexpr std::array<Four, kBins> kDiffuseEfficacy{{{97.24, -0.46, 12.00, -8.91},
                                                    {107.22, 1.15, 0.59, -3.95},
                                                    {104.97, 2.96, -5.53, -8.77},
                                                    {102.39, 5.59, -13.95, -13.90},
                                                    {100.71, 5.94, -22.75, -23.74},
                                                    {106.42, 3.83, -36.15, -28.83},
                                                    {141.88, 1.90, -53.24, -14.03},
                                                    {152.23, 0.35, -45.27, -7.98}}};  // [defined]
constexpr std::array<Four, kBins> kDirectEfficacy{{{57.20, -4.55, -2.98, 117.12},
                                                   {98.99, -3.46, -1.21, 12.38},
                                                   {109.83, -4.90, -1.71, -8.81},
                                                   {110.34, -5.84, -1.99, -4.56},
                                                   {106.36, -3.97, -1.75, -6.16},
                                                   {107.19, -1.25, -1.51, -26.73},
                                                   {105.75, 0.77, -1.26, -34.44},
                                                   {101.18, 1.58, -1.10, -8.29}}};  // [defined]

double kappaOf(double sunZenith) { return kKappa * sunZenith * sunZenith * sunZenith; }

}  // namespace

double outsideIrradiance(double dayOfYear) {
  const double x = 2 * kPi * (dayOfYear - 1) / 365;
  return kSolarConstant * (1.00011 + 0.034221 * std::cos(x) + 0.00128 * std::sin(x) + 0.000719 * std::cos(2 * x) +
                           0.000077 * std::sin(2 * x));
}

double airMass(double sunZenith) {
  return 1 / (std::cos(sunZenith) + 0.15 * std::pow(93.885 - glm::degrees(sunZenith), -1.253));
}

SkyCondition conditionOf(const Daylight& light, double sunZenith, double outside) {
  const double kappa = kappaOf(sunZenith);
  const double ratio = light.diffuse > 0 ? 1 + light.directNormal / light.diffuse : kClearest * (1 + kappa);
  return {sunZenith, std::clamp((ratio + kappa) / (1 + kappa), 1.0, kClearest),
          std::clamp(light.diffuse * airMass(sunZenith) / outside, kDarkest, kBrightest)};
}

Daylight daylightOf(const SkyCondition& sky, double outside) {
  const double diffuse = sky.brightness * outside / airMass(sky.sunZenith);
  return {diffuse * (sky.clearness - 1) * (1 + kappaOf(sky.sunZenith)), diffuse};
}

Daylight efficacies(const SkyCondition& sky, double water) {
  const Four &d = kDiffuseEfficacy[binOf(sky.clearness)], &s = kDirectEfficacy[binOf(sky.clearness)];
  const double direct = s[0] + s[1] * water + s[2] * std::exp(5.73 * sky.sunZenith - 5) + s[3] * sky.brightness;
  const double diffuse = d[0] + d[1] * water + d[2] * std::cos(sky.sunZenith) + d[3] * std::log(sky.brightness);
  return {std::max(0.0, direct), diffuse};
}

std::array<double, 5> perezCoefficients(const SkyCondition& sky) {
  // Between overcast and clear the fit does not hold for darker skies. [Radiance, gendaylit]
  const bool between = sky.clearness > kBounds[0] && sky.clearness < kBounds[4];
  const double Delta = between ? std::max(sky.brightness, 0.2) : sky.brightness, Z = sky.sunZenith;
  const std::size_t bin = binOf(sky.clearness);
  std::array<double, 5> x{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Four& p = kLuminance[bin][i];
    x[i] = p[0] + p[1] * Z + Delta * (p[2] + p[3] * Z);  // [PSM93 (6)]
  }
  if (bin == 0) {
    const Four &c = kLuminance[0][2], &d = kLuminance[0][3];
    x[2] = std::exp(std::pow(Delta * (c[0] + c[1] * Z), c[2])) - c[3];  // [PSM93 (7)]
    x[3] = -std::exp(Delta * (d[0] + d[1] * Z)) + d[2] + Delta * d[3];  // [PSM93 (8)]
  }
  return x;
}

double horizontalIrradiance(const DomeLight& dome) {
  const Frame frame(dome.up);
  const int rings = deltalux::tuning::kPolarAngles, sectors = 2 * rings;
  double sum = 0;
  for (int i = 0; i < rings; ++i) {
    const double sine = std::sqrt((i + 0.5) / rings), cosine = std::sqrt(1 - sine * sine);
    for (int k = 0; k < sectors; ++k) {
      const double azimuth = 2 * kPi * (k + 0.5) / sectors;
      sum += skyRadiance(dome, frame.toWorld({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine})).g;
    }
  }
  return kPi * sum / (rings * sectors);
}

}  // namespace deltalux::scene
