#include "change/line_sieve.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

namespace deltalux::change {

namespace {

constexpr std::size_t kAtOnce = 64;  // [task]

}  // namespace

LineSieve::LineSieve(const MovedSpace& space, const BoxF& from, float stray) {
  const BoxF& all = space.all();
  center_ = 0.5f * (all.lower + all.upper) - 0.5f * (from.lower + from.upper);
  half_ = 0.5f * (all.upper - all.lower) + 0.5f * (from.upper - from.lower);
  far_ = glm::length(glm::abs(center_) + half_);
  half_ += stray * far_;
  far_ += glm::length(half_);
}

void LineSieve::mark(std::span<const lines::LineCode> codes, std::span<char> near) const {
  // Codes as whole words, which vectors can load.
  static_assert(std::endian::native == std::endian::little && sizeof(lines::LineCode) == sizeof(std::uint32_t));
  std::array<std::uint32_t, kAtOnce> words{};
  std::array<std::uint32_t, kAtOnce> marks;
  const Vec3f c = center_, h = half_;
  const float far = far_;
  for (std::size_t begin = 0; begin < codes.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, codes.size() - begin);
    std::memcpy(words.data(), codes.data() + begin, count * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      const auto x = static_cast<float>(static_cast<std::int32_t>(words[i] << 24) >> 24) / 127.0f;
      const auto y = static_cast<float>(static_cast<std::int32_t>(words[i] << 16) >> 24) / 127.0f;
      const float z = 1.0f - std::abs(x) - std::abs(y), below = z < 0 ? -z : 0.0f;
      const float dx = x < 0 ? x + below : x - below, dy = y < 0 ? y + below : y - below;
      const float length = std::bit_cast<float>(words[i] & 0xffff0000u), reach = length < far ? length : far;
      // One over the length of a direction whose coordinates sum to one, or a little more: the chord of 1/sqrt(x).
      const float t = 0.5f * reach * (2.09808f - 1.09807f * (dx * dx + dy * dy + z * z));
      // Half of the segment, about whose middle it lies: apart from the box along one of six axes, or not.
      const float wx = t * dx, wy = t * dy, wz = t * z;
      const float ax = std::abs(wx), ay = std::abs(wy), az = std::abs(wz);
      const float apart = std::max(
          {std::abs(c.x - wx) - (h.x + ax), std::abs(c.y - wy) - (h.y + ay), std::abs(c.z - wz) - (h.z + az),
           std::abs(c.y * wz - c.z * wy) - (h.y * az + h.z * ay), std::abs(c.z * wx - c.x * wz) - (h.z * ax + h.x * az),
           std::abs(c.x * wy - c.y * wx) - (h.x * ay + h.y * ax)});
      marks[i] = apart > 0 ? 0 : 1;
    }
    for (std::size_t i = 0; i < count; ++i) near[begin + i] = static_cast<char>(marks[i]);
  }
}

}  // namespace deltalux::change
