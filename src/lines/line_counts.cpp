#include "lines/line_counts.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "base/tuning.hpp"
#include "base/usual_error.hpp"
#include "hierarchy/patch.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::uint64_t kCountKey = 0x636f756e74735f5full;  // [key]

}  // namespace

std::uint32_t baseLines(double error) {
  const double lines = tuning::kBaseLines * std::pow(kUsualError / error, 2);
  return static_cast<std::uint32_t>(std::clamp(lines, double(deltalux::tuning::kPilots), 65536.0));
}

std::vector<std::uint32_t> lineCounts(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                                      std::span<const float> power, const std::vector<char>& enclosed,
                                      std::uint32_t base) {
  const std::size_t n = leaves.size();
  std::vector<char> out(n);
  double area = 0, sent = 0, live = 0;
  for (std::size_t i = 0; i < n; ++i) {
    out[i] = enclosed[hierarchy::surfaceOf(elements, leaves[i]).index()];
    if (out[i]) continue;
    area += elements.shape(leaves[i]).area, sent += power[i], live += 1;
  }
  // In octaves: sums of area and power hardly change by an edit, how many leaves there are does.
  const double count = std::exp2(std::round(std::log2(std::max(live, 1.0))));
  const double meanArea = area / count, meanPower = sent / count;
  std::vector<std::uint32_t> counts(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    if (out[i]) continue;
    double share = elements.shape(leaves[i]).area / std::max(meanArea, 1e-300);
    if (meanPower > 0) share = std::max(share, power[i] / meanPower);
    // Each leaf has a threshold of its own: when an edit changes the sums a little, few leaves get other lines.
    const double threshold = toUnit(combineKeys(elements.key[leaves[i].index()], kCountKey));
    const auto octaves = static_cast<int>(std::floor(0.5 * std::log2(std::max(share, 1e-12)) + threshold));
    counts[i] = static_cast<std::uint32_t>(
        std::lround(base * std::exp2(std::clamp(octaves, tuning::kFewestOctaves, tuning::kMostOctaves))));
  }
  return counts;
}

}  // namespace deltalux::lines
