#include "engine/light_settling.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "base/paged_array.hpp"
#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "base/room.hpp"
#include "base/sort_unique.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr float kSame = 1e-5f;      // relative difference of light that is none
constexpr float kSamePool = 1e-3f;  // the same of what rows gather too much of
constexpr double kTold = 1e-4;      // of what a region sends: changes that are told at once
constexpr float kMatters = 4e-3f;   // of the irradiance of a leaf: that it does not miss
constexpr double kDark = 1e-3;      // of the mean radiosity: irradiance that is nothing to speak of
constexpr double kLeft = 0.5;       // of what may be missed: what is left when it was more
constexpr double kMost = 0.4;       // of all rows: when it matters to more, all are gathered
constexpr double kWithheld = 0.1;   // the same of what is not told

bool differ(const Rgb& a, const Rgb& b) {
  return maxChannel(glm::abs(a - b)) > kSame * std::max(maxChannel(a), maxChannel(b));
}

/// The sum of a[i] b[i], in parts that are summed side by side.
template <std::size_t N>
float dot(const std::array<std::uint8_t, N>& a, const std::array<float, N>& b) {
  constexpr std::size_t kParts = 16;
  static_assert(N % kParts == 0);
  std::array<float, kParts> parts{};
  for (std::size_t i = 0; i < N; i += kParts)
    for (std::size_t k = 0; k < kParts; ++k) parts[k] += static_cast<float>(a[i + k]) * b[i + k];
  return std::accumulate(parts.begin(), parts.end(), 0.0f);
}

template <class Marks>
void addMarked(const Marks& marks, std::vector<ElementId>& to) {
  for (std::size_t i = 0; i < marks.size(); ++i)
    if (marks[i]) to.emplace_back(i);
}

/// Takes the largest of `amounts` until what is left is no more than `most`; take(index).
template <class Take>
void takeLargest(const std::vector<double>& amounts, double sum, double most, const Take& take) {
  if (!(sum > most)) return;
  std::vector<std::uint32_t> heap;
  for (std::size_t i = 0; i < amounts.size(); ++i)
    if (amounts[i] > 0) heap.push_back(static_cast<std::uint32_t>(i));
  const auto smaller = [&](std::uint32_t a, std::uint32_t b) {
    return amounts[a] != amounts[b] ? amounts[a] < amounts[b] : a > b;
  };
  std::make_heap(heap.begin(), heap.end(), smaller);
  while (sum > most && !heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), smaller);
    sum -= amounts[heap.back()];
    take(heap.back());
    heap.pop_back();
  }
}

}  // namespace

LightSettling::LightSettling(const Parts& parts, const Elements& elements) : regions_(elements) {
  follow(elements);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(ElementId(i))) continue;
    const int r = regions_.of(ElementId(i));
    area_[r] += elements.geometry[i].litArea();
    power_[r] += double(elements.geometry[i].litArea()) * double(gray(seen_[i]));
  }
  const auto rows = parts.rows.rows();
  parallelFor(rows.size(), 256, [&](std::size_t i) {
    if (i + 1 < rows.size()) prefetch(std::span(rows[i + 1].indirect.transfers));
    learn(rows[i]);
  });
  const std::vector<ElementId>& surfaces = parts.particles.surfaces();
  parallelFor(surfaces.size(), 64, [&](std::size_t i) { learn(surfaces[i], parts, elements); });
  pools_ = parts.rows.surplus().pools(elements);
}

void LightSettling::follow(const Elements& elements) {
  regions_.follow(elements);
  const std::size_t known = seen_.size(), size = elements.size();
  resizeWithRoom(seen_, size);
  for (std::size_t i = known; i < size; ++i) seen_[i] = elements.radiometry[i].B;
  resizeWithRoom(from_, size), resizeWithRoom(factors_, size), resizeWithRoom(misses_, size);
  resizeWithRoom(particlesFrom_, size), resizeWithRoom(read_, size), resizeWithRoom(listed_, size);
}

/// By many threads at once, most of which find it marked: then nothing is written that others read.
void LightSettling::markRead(ElementId sender) {
  const std::atomic_ref read(read_[sender.index()]);
  if (!read.load(std::memory_order_relaxed)) read.store(1, std::memory_order_relaxed);
}

void LightSettling::learn(const LeafRow& row) {
  std::array<float, kRegions> factor{};
  SceneRegions::Set regions = 0;
  for (const LeafTransfer& t : row.indirect.transfers) {
    factor[regions_.of(t.leaf)] += gray(t.T);
    regions |= regions_.setOf(t.leaf);
    markRead(t.leaf);
  }
  const std::size_t e = row.leaf.index();
  from_[e] = regions;
  for (int r = 0; r < kRegions; ++r)
    factors_[e][r] = static_cast<std::uint8_t>(std::min(255.0f, std::ceil(255 * factor[r])));
}

void LightSettling::learn(ElementId surface, const Parts& parts, const Elements& elements) {
  SceneRegions::Set regions = 0;
  parts.particles.visitSenders(surface, elements, [&](ElementId sender) {
    regions |= regions_.setOf(sender);
    markRead(sender);
  });
  particlesFrom_[surface.index()] = regions;
}

/// Fills the direct light of all leaves; adds those where it is another.
void LightSettling::addRelit(const Parts& parts, Elements& elements, std::vector<ElementId>& leaves) const {
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

LightSettling::Work LightSettling::firstWork(const Parts& parts, Elements& elements, const LightChanges& changes) {
  follow(elements);
  Work work;
  for (const ElementId e : changes.rows)
    if (parts.rows.find(e))
      work.rows.push_back(e);
    else
      from_[e.index()] = 0, misses_[e.index()] = 0;
  sortUnique(work.rows);

  const std::vector<ElementId>& surfaces = parts.particles.surfaces();
  const std::vector<ElementId>& placed = changes.allParticles ? surfaces : changes.surfaces;
  parallelFor(placed.size(), 16, [&](std::size_t i) { learn(placed[i], parts, elements); });
  PagedArray<char> under(elements.size());
  for (const ElementId e : changes.lights ? surfaces : placed) under.at(e.index()) = 1;
  // Another part of a leaf may be covered than before: the same particles are spread over what is not.
  for (const ElementId e : changes.rows)
    if (const ElementId s = surfaceOf(elements, e);
        !under[s.index()] && std::binary_search(surfaces.begin(), surfaces.end(), s))
      under.at(s.index()) = 1;
  under.forEach([&](std::size_t e, char) { work.surfaces.emplace_back(e); });

  work.leaves = changes.rows;
  if (changes.lights) addRelit(parts, elements, work.leaves);
  for (const ElementId e : changes.painted)
    forEachLeafBelow(elements, e, [&](ElementId leaf) { work.leaves.push_back(leaf); });
  if (changes.allParticles)
    for (std::size_t i = 0; i < elements.size(); ++i) {  // where none land any more
      const ElementId e(i);
      if (!elements.isReceivingLeaf(e) || isBlack(elements.radiometry[i].particle)) continue;
      if (std::binary_search(surfaces.begin(), surfaces.end(), surfaceOf(elements, e))) continue;
      elements.radiometry[i].particle = Rgb(0.0f);
      work.leaves.push_back(e);
    }
  return work;
}

/// Adds the leaves where what is gathered is another. `anew`: the rows are others than they were.
void LightSettling::gather(const Parts& parts, Elements& elements, Work& work, bool anew) {
  const RowSurplus& surplus = parts.rows.surplus();
  std::vector<Rgb> before;
  const auto gatherFrom = [&](std::size_t first) {
    before.resize(work.rows.size());
    parallelFor(work.rows.size() - first, 64, [&](std::size_t k) {
      const std::size_t i = first + k, e = work.rows[i].index();
      before[i] = elements.radiometry[e].indirect;
      const LeafRow& row = *parts.rows.find(work.rows[i]);
      if (i + 1 < work.rows.size()) prefetch(std::span(parts.rows.find(work.rows[i + 1])->indirect.transfers));
      if (anew) learn(row);
      parts.rows.gatherIndirect(row, elements, seen_);
      misses_[e] = 0;
    });
  };
  gatherFrom(0);
  std::vector<ElementId> sharing;
  surplus.listen(elements, surplus.pools(elements), kSamePool, pools_, sharing);
  sortUnique(sharing);
  const std::size_t own = work.rows.size();
  std::erase_if(sharing, [&](ElementId e) { return std::binary_search(work.rows.begin(), work.rows.end(), e); });
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
    parts.particles.apply(work.surfaces, elements, {seen_, parts.scene}, kSame, marks);
    addMarked(marks, work.leaves);
  }
  sortUnique(work.leaves);
  addOtherSides(elements, work.leaves);
}

/// Leaves that may send otherwise; and patches that were leaves when they were taken for senders.
void LightSettling::listen(const Elements& elements, std::span<const ElementId> leaves) {
  const auto add = [&](ElementId e) {
    if (!std::exchange(listed_[e.index()], 1)) unheard_.push_back(e);
  };
  for (const ElementId leaf : leaves) {
    add(leaf);
    for (ElementId e = leaf; elements.at(e).depth > 0;) {
      e = elements.at(e).parent;
      if (read_[e.index()]) add(e);
    }
  }
}

LightSettling::News LightSettling::publish(const Elements& elements, double tolerated) {
  std::vector<double> change(kRegions, 0.0), squares(kRegions, 0.0);
  const auto difference = [&](ElementId e) { return elements.radiometry[e.index()].B - seen_[e.index()]; };
  for (const ElementId e : unheard_) {
    const double A = elements.shape(e).litArea(), dB = gray(glm::abs(difference(e)));
    change[regions_.of(e)] += A * dB, squares[regions_.of(e)] += A * dB * dB;
  }
  News news;
  news.withheld = std::accumulate(change.begin(), change.end(), 0.0);
  const auto tell = [&](std::size_t r) {
    news.regions |= SceneRegions::Set(1) << r;
    news.change[r] = static_cast<float>(std::sqrt(squares[r] / std::max(area_[r], 1e-30)));
    news.withheld -= change[r], change[r] = 0;
  };
  for (std::size_t r = 0; r < kRegions; ++r)
    if (change[r] > kTold * power_[r]) tell(r);
  takeLargest(change, news.withheld, kWithheld * tolerated, tell);
  std::erase_if(unheard_, [&](ElementId e) {
    if (!(news.regions & regions_.setOf(e))) return false;
    if (elements.isLeaf(e)) power_[regions_.of(e)] += elements.shape(e).litArea() * gray(difference(e));
    seen_[e.index()] = elements.radiometry[e.index()].B;
    listed_[e.index()] = 0;
    return true;
  });
  return news;
}

LightSettling::Work LightSettling::readersOf(const News& news, const Parts& parts, const Elements& elements,
                                             double tolerated, double& missed) {
  std::vector<char>& matters = matters_;
  std::vector<double>& amount = amount_;  // that is not reflected
  matters.assign(elements.size(), 0), amount.assign(elements.size(), 0.0);
  const double area = std::accumulate(area_.begin(), area_.end(), 1e-30);
  const auto dark = static_cast<float>(kDark * std::accumulate(power_.begin(), power_.end(), 0.0) / area);
  parallelFor(elements.size(), 1024, [&](std::size_t e) {
    if (!parts.rows.find(ElementId(e))) return;
    if (from_[e] & news.regions) misses_[e] += dot(factors_[e], news.change) / 255;
    if (!(misses_[e] > 0)) return;
    const ElementLight& light = elements.radiometry[e];
    matters[e] = misses_[e] > kMatters * (dark + gray(light.direct + light.indirect + light.particle));
    if (!matters[e])
      amount[e] = double(elements.geometry[e].litArea()) * double(gray(light.rho + light.tau) * misses_[e]);
  });
  missed = std::accumulate(amount.begin(), amount.end(), 0.0);
  if (missed > tolerated)
    takeLargest(amount, missed, kLeft * tolerated, [&](std::size_t e) { matters[e] = 1, missed -= amount[e]; });
  Work work;
  addMarked(matters, work.rows);
  if (static_cast<double>(work.rows.size()) > kMost * static_cast<double>(parts.rows.rows().size())) {
    work.rows = parts.rows.leaves();
    std::sort(work.rows.begin(), work.rows.end());
    missed = 0;
  }
  for (const ElementId e : parts.particles.surfaces())
    if (particlesFrom_[e.index()] & news.regions) work.surfaces.push_back(e);
  return work;
}

double LightSettling::settle(const Parts& parts, Elements& elements, const LightChanges& changes, double tolerated,
                             int most, std::uint64_t& passes) {
  double missed = 0;
  Work work = firstWork(parts, elements, changes);
  for (int pass = 0; pass < most; ++pass) {
    gather(parts, elements, work, pass == 0);
    pull(elements, work.leaves);
    listen(elements, work.leaves);
    ++passes;
    const News news = publish(elements, tolerated);
    work = readersOf(news, parts, elements, tolerated, missed);
    missed += news.withheld;
    if (work.rows.empty() && work.surfaces.empty()) break;
  }
  return missed;
}

}  // namespace deltalux
