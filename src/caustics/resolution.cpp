#include "caustics/resolution.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::caustics {

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
