// Who hears of light that has changed, and when: what matters to a leaf, now; the rest waits. (light_settling.hpp)
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "engine/light_settling.hpp"

namespace deltalux::engine {

namespace {

constexpr double kTold = 1e-4;     // of what a region sends: changes that are told at once
constexpr float kMatters = 4e-3f;  // of the irradiance of a leaf: that it does not miss
constexpr double kDark = 1e-3;     // of the mean radiosity: irradiance that is nothing to speak of
constexpr double kLeft = 0.5;      // of what may be missed: what is left when it was more
constexpr double kWithheld = 0.1;  // the same of what is not told
constexpr double kMost = 0.4;      // of all rows: when it matters to more, all are gathered

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

/// What is of no account by itself, but may be together with others [W].
struct Amount {
  double power;
  std::uint32_t of;
};

/// Takes the largest of the amounts until what is left is no more than `most`; take(amount).
template <class Take>
void takeLargest(std::vector<Amount> heap, double sum, double most, const Take& take) {
  if (!(sum > most)) return;
  const auto smaller = [](const Amount& a, const Amount& b) {
    return a.power != b.power ? a.power < b.power : a.of > b.of;
  };
  std::make_heap(heap.begin(), heap.end(), smaller);
  while (sum > most && !heap.empty()) {
    std::pop_heap(heap.begin(), heap.end(), smaller);
    sum -= heap.back().power;
    take(heap.back());
    heap.pop_back();
  }
}

}  // namespace

/// Leaves that may send otherwise; and patches that were leaves when they were taken for senders.
void LightSettling::listen(const hierarchy::Elements& elements, std::span<const hierarchy::ElementId> leaves) {
  const auto add = [&](hierarchy::ElementId e) {
    Unheard& unheard = unheard_[regions_.of(e)];
    unheard.summed = false;
    if (!std::exchange(listed_[e.index()], 1)) unheard.patches.push_back(e);
  };
  for (const hierarchy::ElementId leaf : leaves) {
    add(leaf);
    for (hierarchy::ElementId e = leaf; elements.at(e).depth > 0;) {
      e = elements.at(e).parent;
      if (read_[e.index()]) add(e);
    }
  }
}

LightSettling::News LightSettling::publish(const hierarchy::Elements& elements, double tolerated) {
  const auto difference = [&](hierarchy::ElementId e) { return elements.radiometry[e.index()].B - seen_[e.index()]; };
  parallelFor(kRegions, 1, [&](std::size_t r) {
    Unheard& u = unheard_[r];
    if (std::exchange(u.summed, true)) return;
    u.change = u.square = 0;
    for (const hierarchy::ElementId e : u.patches) {
      const double A = elements.shape(e).litArea(), dB = gray(glm::abs(difference(e)));
      u.change += A * dB, u.square += A * dB * dB;
    }
  });
  News news;
  for (const Unheard& u : unheard_) news.withheld += u.change;
  const auto tell = [&](std::size_t r) {
    Unheard& u = unheard_[r];
    news.regions |= SceneRegions::Set(1) << r;
    news.change[r] = static_cast<float>(std::sqrt(u.square / std::max(area_[r], 1e-30)));
    news.withheld -= u.change;
    for (const hierarchy::ElementId e : u.patches) {
      if (elements.isLeaf(e)) power_[r] += elements.shape(e).litArea() * gray(difference(e));
      seen_[e.index()] = elements.radiometry[e.index()].B;
      listed_[e.index()] = 0;
    }
    u = {};
  };
  std::vector<Amount> small;
  for (std::uint32_t r = 0; r < kRegions; ++r)
    if (unheard_[r].change > kTold * power_[r])
      tell(r);
    else if (unheard_[r].change > 0)
      small.push_back({unheard_[r].change, r});
  takeLargest(std::move(small), news.withheld, kWithheld * tolerated, [&](const Amount& a) { tell(a.of); });
  return news;
}

LightSettling::Work LightSettling::readersOf(const News& news, const Parts& parts, const hierarchy::Elements& elements,
                                             double tolerated, double& missed) {
  const double area = std::accumulate(area_.begin(), area_.end(), 1e-30);
  const auto dark = static_cast<float>(kDark * std::accumulate(power_.begin(), power_.end(), 0.0) / area);
  std::vector<std::size_t> blocks;  // whose rows hear of it, or miss something
  for (std::size_t b = 0; b < blocksFrom_.size(); ++b)
    if ((blocksFrom_[b] & news.regions) || blocksMiss_[b]) blocks.push_back(b);
  struct Rows {
    std::vector<hierarchy::ElementId> gathered;
    std::vector<Amount> others;  // that is not reflected
  };
  std::vector<Rows> found(blocks.size());
  parallelFor(blocks.size(), 1, [&](std::size_t k) {
    char& miss = blocksMiss_[blocks[k]] = 0;
    const std::size_t begin = blocks[k] * kBlock, end = std::min(begin + kBlock, elements.size());
    for (std::size_t e = begin; e < end; ++e) {
      if (!parts.rows.find(hierarchy::ElementId(e))) continue;
      if (from_[e] & news.regions) misses_[e] += dot(factors_[e], news.change) / 255;
      if (!(misses_[e] > 0)) continue;
      miss = 1;
      const hierarchy::ElementLight& light = elements.radiometry[e];
      if (misses_[e] > kMatters * (dark + gray(light.direct + light.indirect + light.particle)))
        found[k].gathered.emplace_back(e);
      else
        found[k].others.push_back({double(elements.geometry[e].litArea()) * gray(light.rho + light.tau) * misses_[e],
                                   static_cast<std::uint32_t>(e)});
    }
  });
  Work work;
  std::vector<Amount> others;
  missed = 0;
  for (const Rows& rows : found) {
    work.rows.insert(work.rows.end(), rows.gathered.begin(), rows.gathered.end());
    others.insert(others.end(), rows.others.begin(), rows.others.end());
  }
  for (const Amount& a : others) missed += a.power;
  if (missed > tolerated) {
    takeLargest(std::move(others), missed, kLeft * tolerated, [&](const Amount& a) {
      work.rows.emplace_back(a.of);
      missed -= a.power;
    });
    std::sort(work.rows.begin(), work.rows.end());
  }
  if (static_cast<double>(work.rows.size()) > kMost * static_cast<double>(parts.rows.rows().size())) {
    work.rows = parts.rows.leaves();
    std::sort(work.rows.begin(), work.rows.end());
    missed = 0;
  }
  for (const hierarchy::ElementId e : parts.particles.surfaces())
    if (particlesFrom_[e.index()] & news.regions) work.surfaces.push_back(e);
  return work;
}

}  // namespace deltalux::engine
