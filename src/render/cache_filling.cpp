#include "render/cache_filling.hpp"

#include <array>
#include <bit>

#include "base/parallel.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kRows = 16;  // of a block [task]

struct Filling {
  const CacheFrame& frame;
  const HeldPixels& held;
  std::span<const std::uint32_t> surfaces;

  /// The mean over held pixels of the same surface within `reach`, by weightOf(dx, dy); the sum of weights.
  template <class Weight>
  float mean(int x, int y, int reach, const Weight& weightOf, Rgb& L) const {
    const std::size_t home = static_cast<std::size_t>(y) * frame.width + x;
    const std::uint32_t mask = ((1u << (2 * reach + 1)) - 1) << (HeldPixels::kReach - reach);
    float weights = 0;
    Rgb sum(0.0f);
    for (int dy = -reach; dy <= reach; ++dy)
      for (std::uint32_t bits = held.around(x, y + dy) & mask; bits != 0; bits &= bits - 1) {
        const int dx = std::countr_zero(bits) - HeldPixels::kReach;
        const std::size_t p = home + static_cast<std::ptrdiff_t>(dy) * frame.width + dx;
        if (surfaces[p] != surfaces[home]) continue;
        const float w = weightOf(dx, dy);
        sum += w * Rgb(frame.pixels[p]), weights += w;
      }
    if (weights > 0) L = sum / weights;
    return weights;
  }

  /// `near`: whether a neighbour may hold anything.
  glm::vec4 at(int x, int y, bool near) const {
    constexpr float kAll = 4 * 2 + 4 * 1;                                                 // [defined]
    constexpr float kMost = (2 * HeldPixels::kReach + 1) * (2 * HeldPixels::kReach + 1);  // [defined]
    Rgb L(0.0f);
    const auto crosswise = [](int dx, int dy) { return dx == 0 || dy == 0 ? 2.0f : 1.0f; };
    if (const float w = near ? mean(x, y, 1, crosswise, L) : 0.0f; w > 0)
      return {L, (1 + w / kAll) / 2};  // better than any that is filled from all around
    const auto alike = [](int, int) { return 1.0f; };
    const float w = mean(x, y, HeldPixels::kReach, alike, L);
    return {L, w / kMost / 2};
  }
};

}  // namespace

void fillFrame(CacheFrame& frame, const HeldPixels& held, std::span<const std::uint32_t> surfaces) {
  const Filling filling{frame, held, surfaces};
  parallelFor(static_cast<std::size_t>(frame.height), kRows, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    glm::vec4* const pixels = frame.pixels.data() + row * frame.width;
    const std::uint32_t* const seen = surfaces.data() + row * frame.width;
    const HeldPixels::Columns near(held, y, 1), all(held, y, HeldPixels::kReach);
    constexpr std::uint32_t kNear = 7u << (HeldPixels::kReach - 1);  // [layout]
    for (int x = 0; x < frame.width; ++x)
      if (seen[x] != 0 && pixels[x].w < 1 && all.around(x) != 0)
        pixels[x] = filling.at(x, y, (near.around(x) & kNear) != 0);
  });
}

}  // namespace deltalux::rendering
