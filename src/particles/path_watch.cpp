#include "particles/path_watch.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace deltalux::particles {

PathWatch::PathWatch(const Particles& p, const Box& region, double margin)
    : region_(region), box_(region, margin), words_((p.paths() + kPathsOfWord - 1) / kPathsOfWord, 0) {
  parallelFor(words_.size(), 128, [&](std::size_t w) {
    const std::size_t first = w * kPathsOfWord, count = std::min(kPathsOfWord, p.paths() - first);
    for (std::size_t i = 0; i < count; ++i)
      if (comesNear(p, first + i)) words_[w] |= std::uint64_t(1) << i;
  });
}

bool PathWatch::comesNear(const Particles& p, std::size_t path) const {
  const std::span<const Vec3f> v = p.verticesOf(path);
  for (std::size_t i = 0; i + 1 < v.size(); ++i)
    if (box_.meets(v[i], v[i + 1])) return true;
  return v.empty();
}

void PathWatch::renew(const Particles& p, std::span<const std::uint32_t> paths) {
  std::vector<char> near(paths.size());
  parallelFor(paths.size(), 256, [&](std::size_t i) { near[i] = comesNear(p, paths[i]); });
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::uint64_t bit = std::uint64_t(1) << (paths[i] % kPathsOfWord);
    std::uint64_t& word = words_[paths[i] / kPathsOfWord];
    word = near[i] ? word | bit : word & ~bit;
  }
}

}  // namespace deltalux::particles
