#include "particles/count_paths.hpp"

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "base/random.hpp"

namespace deltalux::particles {

namespace {
constexpr std::uint64_t kCountSeed = 0x636f756e747a7a7aull;  // [key]

double arrivingFlux(const DsLinks& links) {
  double arriving = 0;
  for (const DsLink& l : links.all) arriving += double(l.flux) * l.passing;
  return arriving;
}

}  // namespace

double arrivingShare(const DsLinks& links) { return links.flux > 0 ? arrivingFlux(links) / links.flux : 1.0; }

void countPaths(const DsLinks& links, double target, Particles& p) {
  const double arriving = arrivingFlux(links);
  p.quantum = target > 0 ? arriving / target : 0;
  if (!(p.quantum > 0)) return;
  std::uint64_t total = 0;
  for (const DsLink& l : links.all) {
    const double expected = l.flux / p.quantum;
    ParticleLink link{l.ends, l.key, static_cast<std::uint32_t>(total), 0, 0, l.albedo};
    if (expected >= 1) {
      link.paths = static_cast<std::uint32_t>(std::min(std::ceil(expected), 0x1p31));
      link.scale = static_cast<float>(1.0 / link.paths);
    } else if (toUnit(combineKeys(l.key, kCountSeed)) < expected) {
      link.paths = 1;
      link.scale = static_cast<float>(1 / expected);
    } else {
      continue;
    }
    total += link.paths;
    DELTALUX_CHECK(total < 0x80000000ull, "fewer than 2^31 particles");
    p.links.push_back(link);
  }
  p.link.resize(total);
  p.sender.resize(total);
  p.originTriangle.resize(total);
  p.range.resize(total);
  p.account.resize(total);
  p.termination.assign(total, 0);
  for (std::size_t l = 0; l < p.links.size(); ++l)
    std::fill_n(p.link.begin() + p.links[l].firstPath, p.links[l].paths, static_cast<std::uint32_t>(l));
}

}  // namespace deltalux::particles
