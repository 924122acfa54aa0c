// Who hears of light that has changed, and when: what matters to a leaf, now; the rest waits. (light_settling.hpp)
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "engine/light_settling.hpp"

namespace deltalux {

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
  for (std::size_t e = 0; e < matters.size(); ++e)
    if (matters[e]) work.rows.emplace_back(e);
  if (static_cast<double>(work.rows.size()) > kMost * static_cast<double>(parts.rows.rows().size())) {
    work.rows = parts.rows.leaves();
    std::sort(work.rows.begin(), work.rows.end());
    missed = 0;
  }
  for (const ElementId e : parts.particles.surfaces())
    if (particlesFrom_[e.index()] & news.regions) work.surfaces.push_back(e);
  return work;
}

}  // namespace deltalux
