#include "particles/mesh_for_particles.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
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

/// Appends impacts on these sides, in the order of the particles.
void collect(const hierarchy::SideLocator& locator, const Particles& p, const std::vector<char>& sides,
             std::vector<PlacedDeposit>& deposits) {
  constexpr std::size_t kBlock = 4096;  // [task]
  std::vector<std::vector<PlacedDeposit>> found((p.paths() + kBlock - 1) / kBlock);
  parallelFor(p.paths(), kBlock, [&](std::size_t path) {
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      if (!sides[sideIndex(p, i)]) continue;
      const hierarchy::Side on{p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0};
      const hierarchy::ElementId side = locator.side(on.primitive, on.triangle, on.front);
      if (!side.valid()) continue;
      const float power = p.links[p.link[path]].scale * p.nominal[p.sender[path]];
      found[path / kBlock].push_back({locator.leafAt(side, Vec2(p.uv[i])), on, p.uv[i], power * gray(p.throughput[i])});
    }
  });
  for (const auto& block : found) deposits.insert(deposits.end(), block.begin(), block.end());
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

/// By leaf, of those that were not asked.
std::vector<Tally> tally(const hierarchy::Elements& elements, std::span<const PlacedDeposit> deposits,
                         const Details& details) {
  std::vector<std::uint32_t> place(elements.size(), Id<void>::kNone);
  std::vector<Tally> tallies;
  for (const PlacedDeposit& f : deposits) {
    if (details[f.leaf.index()] != Detail::Unasked) continue;
    std::uint32_t& at = place[f.leaf.index()];
    if (at == Id<void>::kNone) at = static_cast<std::uint32_t>(tallies.size()), tallies.emplace_back().leaf = f.leaf;
    tallies[at].quarters[quarterOf(elements, f)].add(f.weight);
    ++tallies[at].count;
  }
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
                                  const std::vector<bool>& coarse, Details& details, const std::vector<bool>& keep) {
  const auto sideOf = [&](hierarchy::ElementId e) {
    return sideIndex(elements.domain[e.index()].primitive, elements.at(e).front);
  };
  std::vector<hierarchy::ElementId> leaves;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (const hierarchy::ElementId e(i); elements.isReceivingLeaf(e) && (keep.empty() || !keep[sideOf(e)]))
      leaves.push_back(e);
  std::vector<char> collected(2 * scene.primitives.size(), false);
  std::vector<PlacedDeposit> deposits;
  std::size_t total = 0;
  while (!leaves.empty()) {
    details.resize(elements.size(), Detail::Unasked);
    const hierarchy::SideLocator locator(elements, scene);
    std::vector<char> sides(collected.size(), false);
    bool unasked = false;
    for (const hierarchy::ElementId e : leaves)
      if (details[e.index()] == Detail::Unasked && !collected[sideOf(e)])
        sides[sideOf(e)] = collected[sideOf(e)] = unasked = true;
    if (unasked) collect(locator, p, sides, deposits);
    for (const Tally& t : tally(elements, deposits, details))
      if (t.count >= deltalux::tuning::kFewestEstimates && showsDetail(t, elements.shape(t.leaf).area))
        details[t.leaf.index()] = Detail::Shown;
    std::vector<hierarchy::ElementId> parts;
    for (const hierarchy::ElementId e : leaves) {
      Detail& detail = details[e.index()];
      if (detail == Detail::Unasked) detail = Detail::Hidden;
      if (detail == Detail::Hidden || (coarse[sideOf(e)] && elements.at(e).depth >= tuning::kShownDepth)) continue;
      if (!hierarchy::subdivide(elements, scene, e)) continue;
      ++total;
      for (std::size_t c = 0; c < elements.at(e).childCount; ++c) parts.push_back(elements.child(e, c));
    }
    leaves = std::move(parts);
    // What stays whole now stays so.
    std::erase_if(deposits, [&](const PlacedDeposit& f) { return elements.isLeaf(f.leaf); });
    const hierarchy::SideLocator finer(elements, scene);
    parallelFor(deposits.size(), 4096, [&](std::size_t i) {
      PlacedDeposit& f = deposits[i];
      const hierarchy::ElementId from =
          elements.hasFaces(f.leaf) ? finer.side(f.side.primitive, f.side.triangle, f.side.front) : f.leaf;
      f.leaf = finer.leafAt(from, Vec2(f.uv));
    });
  }
  return total;
}

void forget(Details& details, const hierarchy::Elements& elements, const Particles& p, const ParticleUpdate& update) {
  if (update.all) return details.clear();
  std::vector<char> sides;  // where particles were, or are, that were traced again
  const auto add = [&](const PathRange& range) {
    for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i) {
      sides.resize(std::max(sides.size(), sideIndex(p, i) + 1), false);
      sides[sideIndex(p, i)] = true;
    }
  };
  for (const RetracedPath& r : update.paths) add(r.range), add(p.range[r.path]);
  for (std::size_t i = 0; i < details.size(); ++i) {
    if (details[i] == Detail::Unasked) continue;
    const std::size_t side = sideIndex(elements.domain[i].primitive, elements.topology[i].front);
    if (side < sides.size() && sides[side]) details[i] = Detail::Unasked;
  }
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
    keep[side] = !(fresh[side] > deltalux::tuning::kChangeMatters * all[side]);
  return keep;
}

}  // namespace deltalux::particles
