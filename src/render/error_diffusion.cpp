#include "render/error_diffusion.hpp"

#include <algorithm>

namespace deltalux::rendering {

std::vector<std::uint32_t> chooseByPriority(std::span<const float> priorities, int width, std::size_t count) {
  std::vector<std::uint32_t> chosen;
  double sum = 0;
  std::size_t positive = 0;
  for (const float p : priorities)
    if (p > 0) sum += double(p), ++positive;
  if (count == 0 || positive == 0) return chosen;
  const bool all = positive <= count;
  chosen.reserve(std::min(positive, count));
  const float step = static_cast<float>(sum / static_cast<double>(count));
  // Error of the row, and of the next one, with room at both ends.
  const std::size_t across = static_cast<std::size_t>(width);
  std::vector<float> own(across + 2, 0.0f), below(across + 2, 0.0f);
  for (std::size_t row = 0; row * across < priorities.size(); ++row) {
    const bool leftwards = row % 2 == 1;
    const std::ptrdiff_t on = leftwards ? -1 : 1;
    for (std::size_t i = 0; i < across; ++i) {
      const std::size_t x = leftwards ? across - 1 - i : i;
      const float p = priorities[row * across + x];
      float* const here = own.data() + 1 + x;
      float* const under = below.data() + 1 + x;
      float error = *here + p;
      if (p > 0 && (all || error >= 0.5f * step)) {
        if (chosen.size() == count) return chosen;
        chosen.push_back(static_cast<std::uint32_t>(row * across + x));
        error -= step;
      }
      if (all) continue;
      here[on] += 7.0f / 16 * error;
      under[-on] += 3.0f / 16 * error, under[0] += 5.0f / 16 * error, under[on] += 1.0f / 16 * error;
    }
    own.swap(below);
    std::fill(below.begin(), below.end(), 0.0f);
  }
  return chosen;
}

}  // namespace deltalux::rendering
