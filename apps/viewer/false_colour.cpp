#include "false_colour.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/math.hpp>

namespace deltalux::viewer {

namespace {
std::vector<double> logarithmicLevels(double top, double decades) {
  std::vector<double> levels;
  const double lowest = top / std::pow(10.0, decades);
  for (int exponent = static_cast<int>(std::floor(std::log10(lowest)));; ++exponent)
    for (const double step : {1.0, 2.0, 5.0}) {
      const double value = step * std::pow(10.0, exponent);
      if (value > top * (1.0 + 1e-9)) return levels;
      if (value >= lowest * (1.0 - 1e-9)) levels.push_back(value);
    }
}
}  // namespace

bool hasBands(const FalseColour& f) { return f.useBands && !f.bands.empty(); }

std::vector<double> scaleLevels(const FalseColour& f) {
  if (hasBands(f)) {
    std::vector<double> bands = f.bands;
    std::sort(bands.begin(), bands.end());
    return bands;
  }
  if (!(f.top > 0) || !std::isfinite(f.top)) return {};
  if (f.logarithmic) return logarithmicLevels(f.top, std::clamp(f.decades, 0.1, 12.0));
  std::vector<double> levels;
  for (int i = 1; i <= 10; ++i) levels.push_back(f.top * i / 10);
  return levels;
}

double scalePosition(const FalseColour& f, double value) {
  if (hasBands(f)) {
    const auto reached = std::count_if(f.bands.begin(), f.bands.end(), [&](double b) { return b <= value; });
    return static_cast<double>(reached) / static_cast<double>(f.bands.size());
  }
  if (!(value > 0) || !(f.top > 0)) return 0;
  return std::clamp(f.logarithmic ? 1.0 + std::log10(value / f.top) / f.decades : value / f.top, 0.0, 1.0);
}

glm::vec3 rampColour(double position) {
  const double lambda = 0.08 + 0.87 * std::clamp(position, 0.0, 1.0);
  const double phi = 2.0 * kPi * (0.5 / 3.0 + 1.0 - 1.5 * lambda);
  const double a = 1.2 * lambda * (1.0 - lambda) / 2.0;
  const auto channel = [&](double cosine, double sine) {  // [Green11 (2)]
    return static_cast<float>(std::clamp(lambda + a * (cosine * std::cos(phi) + sine * std::sin(phi)), 0.0, 1.0));
  };
  return {channel(-0.14861, 1.78277), channel(-0.29227, -0.90649), channel(1.97294, 0.0)};
}

glm::vec3 falseColourRamp(const FalseColour& f, double value) { return rampColour(scalePosition(f, value)); }

}  // namespace deltalux::viewer
