#include "engine/light_settling.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/paged_array.hpp"
#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "base/room.hpp"
#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/pull.hpp"
#include "scene/nominal_scale.hpp"

namespace deltalux::engine {

namespace {

constexpr float kSame = 1e-5f;      // relative difference of light that is none
constexpr float kSamePool = 1e-3f;  // the same of what rows gather too much of

bool differ(const Rgb& a, const Rgb& b) {
  return maxChannel(glm::abs(a - b)) > kSame * std::max(maxChannel(a), maxChannel(b));
}

template <class Marks>
void addMarked(const Marks& marks, std::vector<hierarchy::ElementId>& to) {
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i]) to.emplace_back(i);
}

}  // namespace

LightSettling::LightSettling(const Parts& parts, const hierarchy::Elements& elements) : regions_(elements) {
  follow(elements);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const int r = regions_.of(hierarchy::ElementId(i));
    area_[r] += elements.geometry[i].litArea();
    power_[r] += double(elements.geometry[i].litArea()) * double(gray(seen_[i]));
  }
  const auto rows = parts.rows.rows();
  parallelFor(rows.size(), 256, [&](std::size_t i) {
    if (i + 1 < rows.size()) prefetch(std::span(rows[i + 1].indirect.transfers));
    learn(rows[i]);
  });
  const std::vector<hierarchy::ElementId>& surfaces = parts.particles.surfaces();
  parallelFor(surfaces.size(), 64, [&](std::size_t i) { learn(surfaces[i], parts, elements); });
  pools_ = parts.rows.surplus().pools(elements);
}

void LightSettling::follow(const hierarchy::Elements& elements) {
  regions_.follow(elements);
  const std::size_t known = seen_.size(), size = elements.size();
  resizeWithRoom(seen_, size);
  for (std::size_t i = known; i < size; ++i) seen_[i] = elements.radiometry[i].B;
  resizeWithRoom(from_, size), resizeWithRoom(factors_, size), resizeWithRoom(misses_, size);
  resizeWithRoom(particlesFrom_, size), resizeWithRoom(read_, size), resizeWithRoom(listed_, size);
  blocksFrom_.resize((size + kBlock - 1) / kBlock, 0), blocksMiss_.resize(blocksFrom_.size(), 0);
}

/// By many threads at once, most of which find it marked: then nothing is written that others read.
void LightSettling::markRead(hierarchy::ElementId sender) {
  const std::atomic_ref read(read_[sender.index()]);
  if (!read.load(std::memory_order_relaxed)) read.store(1, std::memory_order_relaxed);
}

/// By many threads at once, as markRead().
void LightSettling::addToBlock(std::size_t block, SceneRegions::Set regions) {
  const std::atomic_ref from(blocksFrom_[block]);
  if (regions & ~from.load(std::memory_order_relaxed)) from.fetch_or(regions, std::memory_order_relaxed);
}

void LightSettling::learn(const radiosity::LeafRow& row) {
  std::array<float, kRegions> factor{};
  SceneRegions::Set regions = 0;
  for (const radiosity::LeafTransfer& t : row.indirect.transfers) {
    factor[regions_.of(t.leaf)] += gray(t.T);
    regions |= regions_.setOf(t.leaf);
    markRead(t.leaf);
  }
  const std::size_t e = row.leaf.index();
  from_[e] = regions;
  addToBlock(e / kBlock, regions);
  for (int r = 0; r < kRegions; ++r)
    factors_[e][r] = static_cast<std::uint8_t>(std::min(255.0f, std::ceil(255 * factor[r])));
}

void LightSettling::learn(hierarchy::ElementId surface, const Parts& parts, const hierarchy::Elements& elements) {
  SceneRegions::Set regions = 0;
  parts.particles.visitSenders(surface, elements, [&](hierarchy::ElementId sender) {
    regions |= regions_.setOf(sender);
    markRead(sender);
  });
  particlesFrom_[surface.index()] = regions;
}

/// Fills the direct light of all leaves; adds those where it is another.
void LightSettling::addRelit(const Parts& parts, hierarchy::Elements& elements,
                             std::vector<hierarchy::ElementId>& leaves) const {
  const auto rows = parts.rows.rows();
  std::vector<char> relit(elements.size(), 0);
  parallelFor(rows.size(), 256, [&](std::size_t i) {
    const std::size_t e = rows[i].leaf.index();
    const Rgb before = elements.radiometry[e].direct;
    parts.rows.gatherDirect(rows[i], elements);
    relit[e] = differ(before, elements.radiometry[e].direct);
  });
  addMarked(relit, leaves);
}

LightSettling::Work LightSettling::firstWork(const Parts& parts, hierarchy::Elements& elements,
                                             const LightChanges& changes) {
  follow(elements);
  Work work;
  for (const hierarchy::ElementId e : changes.rows)
    if (parts.rows.find(e))
      work.rows.push_back(e);
    else
      from_[e.index()] = 0, misses_[e.index()] = 0;
  sortUnique(work.rows);

  const std::vector<hierarchy::ElementId>& surfaces = parts.particles.surfaces();
  const std::vector<hierarchy::ElementId>& placed = changes.allParticles ? surfaces : changes.surfaces;
  parallelFor(placed.size(), 16, [&](std::size_t i) { learn(placed[i], parts, elements); });
  PagedArray<char> under(elements.size());
  for (const hierarchy::ElementId e : changes.lights ? surfaces : placed) under.at(e.index()) = 1;
  // Another part of a leaf may be covered than before: the same particles are spread over what is not.
  for (const hierarchy::ElementId e : changes.rows)
    if (const hierarchy::ElementId s = hierarchy::surfaceOf(elements, e);
        !under[s.index()] && std::binary_search(surfaces.begin(), surfaces.end(), s))
      under.at(s.index()) = 1;
  under.forEach([&](std::size_t e, char) { work.surfaces.emplace_back(e); });

  work.leaves = changes.rows;
  if (changes.lights) addRelit(parts, elements, work.leaves);
  for (const hierarchy::ElementId e : changes.painted)
    hierarchy::forEachLeafBelow(elements, e, [&](hierarchy::ElementId leaf) { work.leaves.push_back(leaf); });
  if (changes.allParticles)
    for (std::size_t i = 0; i < elements.size(); ++i) {  // where none land any more
      const hierarchy::ElementId e(i);
      if (!elements.isReceivingLeaf(e) || isBlack(elements.radiometry[i].particle)) continue;
      if (std::binary_search(surfaces.begin(), surfaces.end(), hierarchy::surfaceOf(elements, e))) continue;
      elements.radiometry[i].particle = Rgb(0.0f);
      work.leaves.push_back(e);
    }
  return work;
}

/// Adds the leaves where what is gathered is another. `anew`: the rows are others than they were.
void LightSettling::gather(const Parts& parts, hierarchy::Elements& elements, Work& work, bool anew) {
  const radiosity::RowSurplus& surplus = parts.rows.surplus();
  std::vector<Rgb> before;
  const auto gatherFrom = [&](std::size_t first) {
    before.resize(work.rows.size());
    parallelFor(work.rows.size() - first, 64, [&](std::size_t k) {
      const std::size_t i = first + k, e = work.rows[i].index();
      before[i] = elements.radiometry[e].indirect;
      const radiosity::LeafRow& row = *parts.rows.find(work.rows[i]);
      if (i + 1 < work.rows.size()) prefetch(std::span(parts.rows.find(work.rows[i + 1])->indirect.transfers));
      if (anew) learn(row);
      parts.rows.gatherIndirect(row, elements, seen_);
      misses_[e] = 0;
    });
  };
  gatherFrom(0);
  std::vector<hierarchy::ElementId> sharing;
  surplus.listen(elements, surplus.pools(elements), kSamePool, pools_, sharing);
  sortUnique(sharing);
  const std::size_t own = work.rows.size();
  std::erase_if(sharing,
                [&](hierarchy::ElementId e) { return std::binary_search(work.rows.begin(), work.rows.end(), e); });
  work.rows.insert(work.rows.end(), sharing.begin(), sharing.end());
  gatherFrom(own);
  std::vector<char> other(work.rows.size(), 0);
  parallelFor(work.rows.size(), 256, [&](std::size_t i) {
    Rgb& indirect = elements.radiometry[work.rows[i].index()].indirect;
    indirect += surplus.share(elements, work.rows[i], pools_);
    other[i] = differ(before[i], indirect);
  });
  for (std::size_t i = 0; i < other.size(); ++i)
    if (other[i]) work.leaves.push_back(work.rows[i]);
  if (!work.surfaces.empty()) {
    std::vector<char> marks(elements.size(), 0);
    parts.particles.apply(work.surfaces, elements, {seen_, scene::scalesOf(parts.scene)}, kSame, marks);
    addMarked(marks, work.leaves);
  }
  sortUnique(work.leaves);
  hierarchy::addOtherSides(elements, work.leaves);
}

double LightSettling::settle(const Parts& parts, hierarchy::Elements& elements, const LightChanges& changes,
                             double tolerated, int most, std::uint64_t& passes) {
  double missed = 0;
  Work work = firstWork(parts, elements, changes);
  for (int pass = 0; pass < most; ++pass) {
    gather(parts, elements, work, pass == 0);
    hierarchy::pull(elements, work.leaves);
    listen(elements, work.leaves);
    ++passes;
    const News news = publish(elements, tolerated);
    work = readersOf(news, parts, elements, tolerated, missed);
    missed += news.withheld;
    if (work.rows.empty() && work.surfaces.empty()) break;
  }
  return missed;
}

}  // namespace deltalux::engine
