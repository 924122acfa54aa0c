#include <deltalux/scene.hpp>

#include "base/check.hpp"

namespace deltalux {

namespace {
std::size_t wrapped(double index, int size) {
  const double remainder = index - std::floor(index / size) * size;
  return std::min(static_cast<std::size_t>(remainder), static_cast<std::size_t>(size) - 1);
}
}  // namespace

Rgb Texture::sample(Vec2 texcoord) const {
  DELTALUX_ASSERT(width > 0 && height > 0 && texels.size() == static_cast<std::size_t>(width) * height);
  if (!std::isfinite(texcoord.x) || !std::isfinite(texcoord.y)) return Rgb(0.0f);
  // Texel centres stand at half-integers.
  const double x = texcoord.x * width - 0.5, y = texcoord.y * height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  const auto across = static_cast<float>(x - left), down = static_cast<float>(y - top);
  const auto at = [&](double column, double row) {
    return texels[wrapped(row, height) * static_cast<std::size_t>(width) + wrapped(column, width)];
  };
  return glm::mix(glm::mix(at(left, top), at(left + 1, top), across),
                  glm::mix(at(left, top + 1), at(left + 1, top + 1), across), down);
}

}  // namespace deltalux
