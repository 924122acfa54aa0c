#include "particles/mesh_for_particles.hpp"

#include <array>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/side_locator.hpp"
#include "particles/side_index.hpp"

namespace deltalux {

namespace {

constexpr int kLevels = 8;
constexpr std::uint32_t kFewest = 32;  // impacts in a leaf that is split: fewer cannot show detail
constexpr int kShownDepth = 5;         // of sides whose particles textures show: enough to send their light on
constexpr double kClearly = 1.5;       // a histogram's noise counts this much more than for placing particles

struct Quarter {
  double sum = 0, squares = 0;

  void add(double w) { sum += w, squares += w * w; }
  /// Estimated squared error of spreading these over `area`. [Rudemo82 (2.8)]
  double error(double area) const { return (2 * kClearly * squares - sum * sum) / area; }
};

struct Tally {
  std::array<Quarter, 4> quarters;
  std::uint32_t count = 0;
};

}  // namespace

std::size_t subdivideForParticles(Elements& elements, const Scene& scene, const Particles& p,
                                  const std::vector<bool>& coarse, const std::vector<bool>& keep) {
  std::vector<ElementId> leaf(p.impactSlots());
  std::vector<float> weights(p.impactSlots());
  {
    const SideLocator locator(elements, scene);
    parallelFor(p.paths(), 1024, [&](std::size_t path) {
      const float power = p.links[p.link[path]].scale * p.nominal[p.sender[path]];
      for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
        if (!keep.empty() && keep[2 * p.primitive[i].index() + (p.triangleAndSide[i] & 1)]) continue;
        const ElementId side = locator.side(p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0);
        if (side.valid()) leaf[i] = locator.leafAt(side, Vec2(p.uv[i]));
        weights[i] = power * gray(p.throughput[i]);
      }
    });
  }
  std::size_t total = 0;
  for (int level = 0; level < kLevels; ++level) {
    std::vector<Tally> tallies(elements.size());
    for (std::size_t i = 0; i < leaf.size(); ++i) {
      if (!leaf[i].valid()) continue;
      const PatchDomain& d = elements.domain[leaf[i].index()];
      const int quarter = (p.uv[i].x > 0.5f * (d.u0 + d.u1) ? 1 : 0) + (p.uv[i].y > 0.5f * (d.v0 + d.v1) ? 2 : 0);
      Tally& t = tallies[leaf[i].index()];
      t.quarters[quarter].add(weights[i]);
      ++t.count;
    }
    std::size_t split = 0;
    for (std::size_t e = 0; e < tallies.size(); ++e) {
      const Tally& t = tallies[e];
      if (t.count < kFewest) continue;
      const bool shown = coarse[sideIndex(elements.domain[e].primitive, elements.topology[e].front)];
      if (shown && elements.topology[e].depth >= kShownDepth) continue;
      const double A = elements.geometry[e].area;
      Quarter whole;
      double parts = 0;
      for (const Quarter& q : t.quarters) {
        parts += q.error(A / 4);
        whole.sum += q.sum, whole.squares += q.squares;
      }
      if (parts < whole.error(A)) split += subdivide(elements, scene, ElementId(e));
    }
    if (split == 0) break;
    total += split;
    const SideLocator locator(elements, scene);
    parallelFor(leaf.size(), 4096, [&](std::size_t i) {
      if (leaf[i].valid()) leaf[i] = locator.leafAt(leaf[i], Vec2(p.uv[i]));
    });
  }
  return total;
}

std::vector<bool> sidesThatKeepTheirMesh(const Scene& scene, const Particles& p, const ParticleUpdate& update) {
  constexpr double kMatters = 0.1;
  std::vector<bool> keep(2 * scene.primitives.size(), false);
  if (update.all) return keep;
  std::vector<double> all(keep.size(), 0.0), fresh(keep.size(), 0.0);
  const auto add = [&](std::size_t path, std::vector<double>& to) {
    const double power = p.weight(path);
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      to[2 * p.primitive[i].index() + (p.triangleAndSide[i] & 1)] += power * gray(p.throughput[i]);
  };
  for (const RetracedPath& r : update.paths) add(r.path, fresh);
  constexpr std::size_t kParts = 8;  // summed apart
  std::vector<std::vector<double>> parts(kParts, all);
  parallelFor(kParts, 1, [&](std::size_t part) {
    for (std::size_t path = part * p.paths() / kParts; path < (part + 1) * p.paths() / kParts; ++path)
      add(path, parts[part]);
  });
  for (const auto& part : parts)
    for (std::size_t side = 0; side < all.size(); ++side) all[side] += part[side];
  for (std::size_t side = 0; side < keep.size(); ++side) keep[side] = !(fresh[side] > kMatters * all[side]);
  return keep;
}

}  // namespace deltalux
