#include "render/solution_mesh/touching_points.hpp"

#include <algorithm>
#include <deltalux/ids.hpp>

#include "base/box_tree.hpp"
#include "base/random.hpp"

namespace deltalux::rendering {

namespace {

constexpr double kCell = 16;  // in tolerances [task]

BoxF boxAround(const Vec3& low, const Vec3& high, double slack) {
  // Single precision may round a point out of its own box.
  const double rounding = 1e-6 * std::max(glm::length(low), glm::length(high));
  return {Vec3f(low - slack - rounding), Vec3f(high + slack + rounding)};
}

}  // namespace

std::uint64_t TouchingPoints::cellOf(const Vec3& p) const {
  const Vec3 cell = glm::floor(p / (kCell * tolerance_));
  const auto bits = [](double c) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(c)); };
  return combineKeys(combineKeys(bits(cell.x), bits(cell.y)), bits(cell.z));
}

std::uint32_t TouchingPoints::add(const Vec3& p) {
  std::uint64_t seen[8];
  int count = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 side((corner & 1) ? 1 : -1, (corner & 2) ? 1 : -1, (corner & 4) ? 1 : -1);
    const std::uint64_t cell = cellOf(p + tolerance_ * side);
    if (std::find(seen, seen + count, cell) != seen + count) continue;
    seen[count++] = cell;
    const auto found = cells_.find(cell);
    if (found == cells_.end()) continue;
    for (std::uint32_t i = found->second; i != Id<void>::kNone; i = nextInCell_[i]) {
      const Vec3 d = points_[i] - p;
      if (glm::dot(d, d) <= tolerance_ * tolerance_) return i;
    }
  }
  const auto point = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  const auto [place, fresh] = cells_.try_emplace(cellOf(p), point);
  nextInCell_.push_back(fresh ? Id<void>::kNone : place->second);
  place->second = point;
  return point;
}

TouchingPoints::Rings TouchingPoints::withTouching(const Rings& rings) const {
  std::vector<BoxF> boxes(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) boxes[i] = boxAround(points_[i], points_[i], 0);
  const BoxTree tree(std::move(boxes));
  Rings result;
  result.points.reserve(2 * rings.points.size());
  std::vector<std::pair<double, std::uint32_t>> on;
  for (std::size_t r = 0; r < rings.size(); ++r) {
    for (std::uint32_t k = rings.begin[r]; k < rings.begin[r + 1]; ++k) {
      const std::uint32_t from = rings.points[k];
      const std::uint32_t to = rings.points[k + 1 < rings.begin[r + 1] ? k + 1 : rings.begin[r]];
      result.points.push_back(from);
      const Vec3 a = points_[from], b = points_[to], d = b - a;
      const double squared = glm::dot(d, d);
      on.clear();
      tree.overlapping(boxAround(glm::min(a, b), glm::max(a, b), tolerance_), [&](std::uint32_t i) {
        if (i == from || i == to) return;
        const double t = glm::dot(points_[i] - a, d) / squared;
        const Vec3 off = points_[i] - (a + t * d);
        if (t > 0 && t < 1 && glm::dot(off, off) <= tolerance_ * tolerance_) on.push_back({t, i});
      });
      std::sort(on.begin(), on.end());
      for (const auto& [t, i] : on) result.points.push_back(i);
    }
    result.close();
  }
  return result;
}

}  // namespace deltalux::rendering
