#include "caustics/resolution.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::caustics {

int paperResolution(double particles, double epsilon, double kernel) {
  if (!(particles > 0)) return 0;
  const double d = std::log(particles * epsilon / kernel) / (2 * std::log(2.0)) - 1;  // [GD01 (7)]
  return std::max(0, static_cast<int>(std::floor(d + 1e-9)));
}

glm::ivec2 paperTexels(double particles, double epsilon, const glm::dvec2& size) {
  const int both = 2 * paperResolution(particles, epsilon);
  const double aspect = size.y > 0 && size.x > 0 ? std::log2(size.x / size.y) : 0.0;
  const int across = std::clamp(static_cast<int>(std::lround(0.5 * (both + aspect))), 0, both);
  return {1 << across, 1 << (both - across)};
}

glm::ivec2 squareTexels(const glm::dvec2& size, double area, int most) {
  const double side = std::sqrt(std::max(area, size.x * size.y / most));
  const auto along = [&](double length) {
    return std::clamp(static_cast<int>(std::ceil(length / side - 1e-9)), 1, most);
  };
  glm::ivec2 texels(along(size.x), along(size.y));
  // A strip one texel wide has fewer texels to spend than its area says.
  texels.x = std::min(texels.x, std::max(1, most / texels.y)),
  texels.y = std::min(texels.y, std::max(1, most / texels.x));
  return texels;
}

double texelArea(const ChartPart& part, double perTexel) {
  std::vector<double> flux(part.areas.size(), 0.0), squares(part.areas.size(), 0.0);
  double total = 0, totalSquares = 0;
  const Vec2 perUnit = Vec2(part.texels) / part.region.size();
  for (const ChartImpact& impact : part.impacts) {
    const Vec2 at = (impact.st - part.region.lower) * perUnit;
    const int x = std::clamp(static_cast<int>(at.x), 0, part.texels.x - 1);
    const int y = std::clamp(static_cast<int>(at.y), 0, part.texels.y - 1);
    const std::size_t texel = static_cast<std::size_t>(y) * part.texels.x + x;
    const double g = gray(impact.flux);
    flux[texel] += g, squares[texel] += g * g;
    total += g, totalSquares += g * g;
  }
  const double typical = typicalIrradiance(flux, squares, part.areas);
  return typical > 0 ? perTexel * totalSquares / total / typical : part.region.size().x * part.region.size().y;
}

}  // namespace deltalux::caustics
