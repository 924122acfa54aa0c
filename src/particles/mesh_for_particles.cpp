#include "particles/mesh_for_particles.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/side_locator.hpp"
#include "particles/side_index.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

namespace {

struct Quarter {
  double sum = 0, squares = 0;

  void add(double w) { sum += w, squares += w * w; }
  /// Estimated squared error of spreading these over `area`. [Rudemo82 (2.8)]
  double error(double area) const { return (2 * tuning::kClearly * squares - sum * sum) / area; }
};

/// What was deposited on a leaf.
struct Tally {
  hierarchy::ElementId leaf;
  std::array<Quarter, 4> quarters;
  std::uint32_t count = 0;
};

struct PlacedDeposit {
  hierarchy::ElementId leaf;
  hierarchy::Side side;
  glm::vec2 uv{0.0f};
  float weight = 0;
};

/// Impacts on sides that do not keep their mesh, in the order of the particles.
std::vector<PlacedDeposit> depositsOn(const hierarchy::Elements& elements, const Scene& scene, const Particles& p,
                                      const std::vector<bool>& keep) {
  constexpr std::size_t kBlock = 4096;  // [task]
  std::vector<std::vector<PlacedDeposit>> found((p.paths() + kBlock - 1) / kBlock);
  const hierarchy::SideLocator locator(elements, scene);
  parallelFor(p.paths(), kBlock, [&](std::size_t path) {
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      if (!keep.empty() && keep[sideIndex(p, i)]) continue;
      const hierarchy::Side on{p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0};
      const hierarchy::ElementId side = locator.side(on.primitive, on.triangle, on.front);
      if (!side.valid()) continue;
      const float power = p.links[p.link[path]].scale * p.nominal[p.sender[path]];
      found[path / kBlock].push_back({locator.leafAt(side, Vec2(p.uv[i])), on, p.uv[i], power * gray(p.throughput[i])});
    }
  });
  std::vector<PlacedDeposit> all;
  for (const auto& block : found) all.insert(all.end(), block.begin(), block.end());
  return all;
}

/// Which quarter of its leaf's area something was deposited on: of its rectangle, or of its faces in order.
std::size_t quarterOf(const hierarchy::Elements& elements, const PlacedDeposit& f) {
  if (elements.hasFaces(f.leaf)) {
    const hierarchy::FaceRange range = elements.facesOf(f.leaf);
    const hierarchy::FaceOrder& order = elements.orderOf(f.leaf);
    const std::uint32_t before = order.placeOf(f.side.triangle) - range.first;
    return static_cast<std::size_t>(std::min(4 * order.area({range.first, before}) / order.area(range), 3.0));
  }
  const hierarchy::PatchDomain& d = elements.domain[f.leaf.index()];
  return (f.uv.x > 0.5f * (d.u0 + d.u1) ? 1u : 0u) + (f.uv.y > 0.5f * (d.v0 + d.v1) ? 2u : 0u);
}

/// By leaf, in the order of ids.
std::vector<Tally> tally(const hierarchy::Elements& elements, std::span<const PlacedDeposit> deposits) {
  std::vector<std::uint32_t> place(elements.size(), Id<void>::kNone);
  std::vector<Tally> tallies;
  for (const PlacedDeposit& f : deposits) {
    std::uint32_t& at = place[f.leaf.index()];
    if (at == Id<void>::kNone) at = static_cast<std::uint32_t>(tallies.size()), tallies.emplace_back().leaf = f.leaf;
    tallies[at].quarters[quarterOf(elements, f)].add(f.weight);
    ++tallies[at].count;
  }
  std::sort(tallies.begin(), tallies.end(), [](const Tally& a, const Tally& b) { return a.leaf < b.leaf; });
  return tallies;
}

/// Whether quarters of the leaf show what was deposited on it clearly better than the whole.
bool showsDetail(const Tally& t, double area) {
  Quarter whole;
  double parts = 0;
  for (const Quarter& q : t.quarters) {
    parts += q.error(area / 4);
    whole.sum += q.sum, whole.squares += q.squares;
  }
  return parts < whole.error(area);
}

}  // namespace

std::size_t subdivideForParticles(hierarchy::Elements& elements, const Scene& scene, const Particles& p,
                                  const std::vector<bool>& coarse, const std::vector<bool>& keep) {
  std::vector<PlacedDeposit> deposits = depositsOn(elements, scene, p, keep);
  std::size_t total = 0;
  while (!deposits.empty()) {
    std::size_t split = 0;
    for (const Tally& t : tally(elements, deposits)) {
      if (t.count < tuning::kDetail) continue;
      const hierarchy::ElementTopology& e = elements.at(t.leaf);
      if (coarse[sideIndex(elements.domain[t.leaf.index()].primitive, e.front)] && e.depth >= tuning::kShownDepth)
        continue;
      if (showsDetail(t, elements.shape(t.leaf).area)) split += hierarchy::subdivide(elements, scene, t.leaf);
    }
    if (split == 0) break;
    total += split;
    // What stays whole now stays so.
    std::erase_if(deposits, [&](const PlacedDeposit& f) { return elements.isLeaf(f.leaf); });
    const hierarchy::SideLocator locator(elements, scene);
    parallelFor(deposits.size(), 4096, [&](std::size_t i) {
      PlacedDeposit& f = deposits[i];
      const hierarchy::ElementId from =
          elements.hasFaces(f.leaf) ? locator.side(f.side.primitive, f.side.triangle, f.side.front) : f.leaf;
      f.leaf = locator.leafAt(from, Vec2(f.uv));
    });
  }
  return total;
}

std::vector<bool> sidesThatKeepTheirMesh(const Scene& scene, const Particles& p, const ParticleUpdate& update) {
  std::vector<bool> keep(2 * scene.primitives.size(), false);
  if (update.all) return keep;
  std::vector<double> all(keep.size(), 0.0), fresh(keep.size(), 0.0);
  const auto add = [&](std::size_t path, std::vector<double>& to) {
    const double power = p.weight(path);
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      to[2 * p.primitive[i].index() + (p.triangleAndSide[i] & 1)] += power * gray(p.throughput[i]);
  };
  for (const RetracedPath& r : update.paths) add(r.path, fresh);
  constexpr std::size_t kParts = 8;  // summed apart [task]
  std::vector<std::vector<double>> parts(kParts, all);
  parallelFor(kParts, 1, [&](std::size_t part) {
    for (std::size_t path = part * p.paths() / kParts; path < (part + 1) * p.paths() / kParts; ++path)
      add(path, parts[part]);
  });
  for (const auto& part : parts)
    for (std::size_t side = 0; side < all.size(); ++side) all[side] += part[side];
  for (std::size_t side = 0; side < keep.size(); ++side)
    keep[side] = !(fresh[side] > tuning::kChangeMatters * all[side]);
  return keep;
}

}  // namespace deltalux::particles
