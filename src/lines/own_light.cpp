#include "lines/own_light.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kOwnLeaves = 1024;  // of a task [task]

}  // namespace

std::vector<float> ownIndirect(const Lines& lines, const hierarchy::LeafTable& leaves,
                               std::span<const std::uint32_t> counts, std::span<const float> rho,
                               std::span<const float> source) {
  const std::size_t n = leaves.size();
  std::vector<float> indirect(n, 0), brightest(n, 0), B(leaves.indexOf.size(), 0);  // the last by element
  for (int bounce = 0; bounce < tuning::kDimBounces; ++bounce) {
    parallelFor(n, kOwnLeaves, [&](std::size_t i) { B[leaves[i].index()] = rho[i] * (source[i] + indirect[i]); });
    parallelFor(n, kOwnLeaves, [&](std::size_t i) {
      float sum = 0, most = 0;
      const auto add = [&](float light) { sum += light, most = std::max(most, light); };
      for (const ExceptionalLine& e : lines.exceptions.at(leaves[i])) {
        if (e.number >= counts[i]) break;
        add(gray(e.weight) * B[e.end]);
      }
      std::uint32_t covered = 0;
      for (const std::uint32_t end : lines.endsOf(leaves[i]).first(counts[i])) {
        if (end < kFirstMark) add(B[end]);
        covered += end == kCovered;
      }
      const auto count = static_cast<float>(counts[i] - covered);
      indirect[i] = count > 0 ? sum / count : 0.0f, brightest[i] = count > 0 ? most / count : 0.0f;
    });
  }
  for (std::size_t i = 0; i < n; ++i) indirect[i] -= brightest[i];
  return indirect;
}

}  // namespace deltalux::lines
