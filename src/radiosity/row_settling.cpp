#include "radiosity/row_settling.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
#include "radiosity/push_pull.hpp"

namespace deltalux {

namespace {

constexpr float kSeen = 1e-5f;  // relative change of a sender's radiosity that rows need not hear of yet
constexpr int kSide = 8;        // regions along each of the two longest sides of the scene

}  // namespace

RowSettling::RowSettling(const LeafTransfers& transfers, const Elements& elements) {
  label(elements);
  from_.assign(elements.size(), 0);
  const auto rows = transfers.rows();
  parallelFor(rows.size(), 256, [&](std::size_t i) { from_[rows[i].leaf.index()] = regionsOf(rows[i]); });
}

void RowSettling::label(const Elements& elements) {
  const Vec3f lower(elements.sceneBox.lower), size = Vec3f(elements.sceneBox.upper) - lower;
  const int shortest = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
  const int a = shortest == 0 ? 1 : 0, b = shortest == 2 ? 1 : 2;
  const auto cell = [&](const Vec3f& p, int axis) {
    return std::clamp(static_cast<int>(kSide * (p[axis] - lower[axis]) / std::max(size[axis], 1e-30f)), 0, kSide - 1);
  };
  for (std::size_t i = region_.size(); i < elements.size(); ++i) {
    const Vec3f& p = elements.geometry[i].center;
    region_.push_back(static_cast<std::uint8_t>(kSide * cell(p, a) + cell(p, b)));
    seen_.push_back(elements.radiometry[i].B);
  }
}

std::uint64_t RowSettling::regionsOf(const LeafRow& row) const {
  std::uint64_t regions = 0;
  for (const LeafTransfer& t : row.indirect.transfers) regions |= std::uint64_t(1) << region_[t.leaf.index()];
  return regions;
}

RgbSum RowSettling::unheard(const Elements& elements) const {
  RgbSum power(0.0);
  for (const ElementId e : unheard_)
    power += RgbSum(elements.shape(e).litArea() * glm::abs(elements.radiometry[e.index()].B - seen_[e.index()]));
  return power;
}

RgbSum RowSettling::settle(const LeafTransfers& transfers, Elements& elements, std::span<const ElementId> changed,
                           double tolerated, int most, std::uint64_t& passes) {
  label(elements);
  from_.resize(elements.size(), 0);
  const auto rows = transfers.rows();
  std::vector<std::uint32_t> active;
  std::vector<ElementId> dark;  // leaves that have no row any more
  {
    std::vector<char> marked(elements.size(), 0);
    for (const ElementId e : changed) marked[e.index()] = 1;
    for (std::uint32_t i = 0; i < rows.size(); ++i)
      if (std::exchange(marked[rows[i].leaf.index()], 0)) active.push_back(i);
    for (const ElementId e : changed)
      if (std::exchange(marked[e.index()], 0)) dark.push_back(e), from_[e.index()] = 0;
  }
  for (const std::uint32_t i : active) from_[rows[i].leaf.index()] = regionsOf(rows[i]);

  RgbSum unsettled(0.0);
  std::vector<ElementId> leaves;
  for (int pass = 0; pass < most; ++pass) {
    parallelFor(active.size(), 64, [&](std::size_t i) { transfers.gatherIndirect(rows[active[i]], elements, seen_); });
    leaves.clear();
    for (const std::uint32_t i : active) leaves.push_back(rows[i].leaf);
    if (pass == 0) leaves.insert(leaves.end(), dark.begin(), dark.end());
    pull(elements, leaves);
    ++passes;
    unheard_.insert(unheard_.end(), leaves.begin(), leaves.end());
    std::sort(unheard_.begin(), unheard_.end());
    unheard_.erase(std::unique(unheard_.begin(), unheard_.end()), unheard_.end());
    unsettled = unheard(elements);
    if (gray(unsettled) <= tolerated) break;
    std::uint64_t news = 0;
    for (const ElementId e : unheard_) {
      const Rgb B = elements.radiometry[e.index()].B, seen = seen_[e.index()];
      if (maxChannel(glm::abs(B - seen)) <= kSeen * std::max(maxChannel(B), maxChannel(seen))) continue;
      seen_[e.index()] = B;
      news |= std::uint64_t(1) << region_[e.index()];
    }
    unheard_.clear();
    active.clear();
    for (std::uint32_t i = 0; i < rows.size(); ++i)
      if (from_[rows[i].leaf.index()] & news) active.push_back(i);
  }
  return unsettled;
}

}  // namespace deltalux
