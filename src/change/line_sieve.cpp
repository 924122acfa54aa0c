#include "change/line_sieve.hpp"

#include <cmath>

namespace deltalux::change {

LineSieve::LineSieve(const MovedSpace& space, const BoxF& from, float stray) {
  const BoxF& all = space.all();
  center_ = 0.5f * (all.lower + all.upper) - 0.5f * (from.lower + from.upper);
  half_ = 0.5f * (all.upper - all.lower) + 0.5f * (from.upper - from.lower);
  far_ = glm::length(glm::abs(center_) + half_);
  half_ += stray * far_;
  far_ += glm::length(half_);
}

void LineSieve::mark(std::span<const lines::LineCode> codes, std::span<char> near) const {
  const Vec3f c = center_, h = half_;
  const float far = far_;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const lines::LineCode code = codes[i];
    const float x = static_cast<float>(code.x) / 127.0f, y = static_cast<float>(code.y) / 127.0f;
    const float z = 1.0f - std::abs(x) - std::abs(y), below = z < 0 ? -z : 0.0f;
    const float dx = x < 0 ? x + below : x - below, dy = y < 0 ? y + below : y - below;
    const float length = lines::lengthOf(code), reach = length < far ? length : far;
    // One over the length of a direction whose coordinates sum to one, or a little more: the chord of 1/sqrt(x).
    const float t = 0.5f * reach * (2.09808f - 1.09807f * (dx * dx + dy * dy + z * z));
    // Half of the segment, about whose middle it lies: separated from the box along one of six axes, or not.
    const float wx = t * dx, wy = t * dy, wz = t * z;
    const float ax = std::abs(wx), ay = std::abs(wy), az = std::abs(wz);
    const bool apart = (std::abs(c.x - wx) > h.x + ax) | (std::abs(c.y - wy) > h.y + ay) |
                       (std::abs(c.z - wz) > h.z + az) | (std::abs(c.y * wz - c.z * wy) > h.y * az + h.z * ay) |
                       (std::abs(c.z * wx - c.x * wz) > h.z * ax + h.x * az) |
                       (std::abs(c.x * wy - c.y * wx) > h.x * ay + h.y * ax);
    near[i] = apart ? 0 : 1;
  }
}

}  // namespace deltalux::change
