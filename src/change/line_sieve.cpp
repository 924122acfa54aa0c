#include "change/line_sieve.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "change/separating_axes.hpp"

namespace deltalux::change {

namespace {

constexpr std::size_t kAtOnce = 64;  // [task]
constexpr std::size_t kVector = 16;  // codes of a vector, at most [layout]

}  // namespace

LineSieve::LineSieve(const MovedSpace& space, const BoxF& from, float stray) {
  const Vec3f point = 0.5f * (from.lower + from.upper), wide = 0.5f * (from.upper - from.lower);
  for (const BoxF& box : space.around()) {
    const Vec3f center = 0.5f * (box.lower + box.upper) - point, half = 0.5f * (box.upper - box.lower) + wide;
    const float far = glm::length(glm::abs(center) + half);
    const Vec3f strayed = half + stray * far;
    targets_[count_++] = {center, strayed, far + glm::length(strayed)};
  }
}

void LineSieve::mark(std::span<const lines::LineCode> codes, std::span<char> near) const {
  // Codes as whole words, which vectors can load.
  static_assert(std::endian::native == std::endian::little && sizeof(lines::LineCode) == sizeof(std::uint32_t));
  std::array<std::uint32_t, kAtOnce> words{}, marks;
  std::array<float, kAtOnce> directionX, directionY, directionZ, perLength, lengths;
  constexpr float perStep = 1 / 127.0f;  // its rounding is far less than lines may go astray
  for (std::size_t begin = 0; begin < codes.size(); begin += kAtOnce) {
    const std::size_t count = std::min(kAtOnce, codes.size() - begin);
    const std::size_t end = (count + kVector - 1) / kVector * kVector;
    std::memcpy(words.data(), codes.data() + begin, count * sizeof(std::uint32_t));
    for (std::size_t i = 0; i < end; ++i) {
      const auto x = perStep * static_cast<float>(static_cast<std::int32_t>(words[i] << 24) >> 24);
      const auto y = perStep * static_cast<float>(static_cast<std::int32_t>(words[i] << 16) >> 24);
      const float z = 1.0f - std::abs(x) - std::abs(y), below = z < 0 ? -z : 0.0f;
      const float dx = x < 0 ? x + below : x - below, dy = y < 0 ? y + below : y - below;
      directionX[i] = dx, directionY[i] = dy, directionZ[i] = z;
      // One over the length of a direction whose coordinates sum to one, or a little more: the chord of 1/sqrt(x).
      perLength[i] = 2.09808f - 1.09807f * (dx * dx + dy * dy + z * z);
      lengths[i] = std::bit_cast<float>(words[i] & 0xffff0000u);
      marks[i] = 0;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      const Vec3f c = targets_[k].center, h = targets_[k].half;
      const float far = targets_[k].far;
      for (std::size_t i = 0; i < end; ++i) {
        const float t = 0.5f * (lengths[i] < far ? lengths[i] : far) * perLength[i];
        const bool misses =
            apart(c.x, c.y, c.z, h.x, h.y, h.z, t * directionX[i], t * directionY[i], t * directionZ[i]) > 0;
        marks[i] |= misses ? 0 : 1;
      }
    }
    for (std::size_t i = 0; i < count; ++i) near[begin + i] = static_cast<char>(marks[i]);
  }
}

}  // namespace deltalux::change
