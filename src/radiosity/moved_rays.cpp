#include "radiosity/moved_rays.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace deltalux::radiosity {

void meetsRays(const paper::SpaceChange& space, const hierarchy::ElementGeometry& from, std::span<const RayCode> rays,
               std::vector<std::uint32_t>& out) {
  if (space.empty()) return;
  constexpr float kSmallest = 1e-6f;  // of a coordinate of a direction
  constexpr std::size_t kMost = 64;
  // As far as a ray of the box, or one whose direction is not quite the coded one, may be from that of its middle.
  const Vec3f center = 0.5f * (from.lower + from.upper), half = 0.5f * (from.upper - from.lower);
  const Vec3f far = glm::max(glm::abs(space.bounds().lower - center), glm::abs(space.bounds().upper - center));
  const Vec3f grown = half + 1.05f * kDirectionCodeError * glm::length(far + half);
  const Vec3f lower = space.bounds().lower - grown - center, upper = space.bounds().upper + grown - center;
  std::array<std::uint8_t, kMost> meets;
  for (std::size_t begin = 0; begin < rays.size(); begin += kMost) {
    const std::size_t count = std::min(kMost, rays.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t bits = rays[begin + i].bits;
      const RayCode ray{bits};
      const Vec3f d = direction(towards(ray));
      float nearest = (blocked(ray) ? 1 - kRayCodeError : 0.0f) * end(ray);
      float furthest = (1 + kRayCodeError) * end(ray);
      for (int axis = 0; axis < 3; ++axis) {
        const float inverse = 1.0f / std::copysign(std::max(std::abs(d[axis]), kSmallest), d[axis]);
        const float a = lower[axis] * inverse, b = upper[axis] * inverse;
        nearest = std::max(nearest, std::min(a, b));
        furthest = std::min(furthest, std::max(a, b));
      }
      meets[i] = nearest <= furthest;
    }
    for (std::size_t i = 0; i < count; ++i)
      if (meets[i]) out.push_back(static_cast<std::uint32_t>(begin + i));
  }
}

}  // namespace deltalux::radiosity
