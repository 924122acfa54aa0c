#include "particles/path_watch.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace deltalux {

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

void PathWatch::renew(const Particles& p, std::size_t path) {
  const std::uint64_t bit = std::uint64_t(1) << (path % kPathsOfWord);
  std::uint64_t& word = words_[path / kPathsOfWord];
  word = comesNear(p, path) ? word | bit : word & ~bit;
}

}  // namespace deltalux
