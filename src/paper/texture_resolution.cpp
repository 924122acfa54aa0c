#include "paper/texture_resolution.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux::paper {

int textureResolution(double particles, double epsilon, double kernel) {
  if (!(particles > 0)) return 0;
  const double d = std::log(particles * epsilon / kernel) / (2 * std::log(2.0)) - 1;  // [GD01 (7)]
  return std::max(0, static_cast<int>(std::floor(d + 1e-9)));
}

glm::ivec2 textureTexels(double particles, double epsilon, const glm::dvec2& size) {
  const int both = 2 * textureResolution(particles, epsilon);
  const double aspect = size.y > 0 && size.x > 0 ? std::log2(size.x / size.y) : 0.0;
  const int across = std::clamp(static_cast<int>(std::lround(0.5 * (both + aspect))), 0, both);
  return {1 << across, 1 << (both - across)};
}

}  // namespace deltalux::paper
