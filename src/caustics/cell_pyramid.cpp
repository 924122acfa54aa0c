#include "caustics/cell_pyramid.hpp"

#include <algorithm>
#include <numeric>

namespace deltalux {

namespace {

constexpr float kThrough = 0.5f;  // openness of borders that cells join over

/// Cells that hang together within squares of two by two: the first of them, by cell.
std::vector<std::uint32_t> joined(const CellGraph& graph, Openness open) {
  std::vector<std::uint32_t> root(graph.size());
  std::iota(root.begin(), root.end(), 0u);
  std::vector<std::uint64_t> square(graph.size());
  for (std::size_t i = 0; i < graph.size(); ++i) {
    const glm::ivec2 p = graph.place(i) / 2;
    square[i] = std::uint64_t(p.y) << 32 | std::uint32_t(p.x);
  }
  const auto rootOf = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  graph.forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t border, bool) {
    if (b > a || square[a] != square[b] || (!open.empty() && open[border] < kThrough)) return;
    const std::uint32_t p = rootOf(a), q = rootOf(b);
    root[std::max(p, q)] = std::min(p, q);
  });
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = rootOf(i);
  return root;
}

}  // namespace

CellPyramid::Level CellPyramid::coarsened(const CellGraph& fine, Openness open) {
  Level level;
  level.of = joined(fine, open);
  std::vector<float> areas;
  std::vector<glm::ivec2> places;
  for (std::uint32_t i = 0; i < fine.size(); ++i) {
    const bool first = level.of[i] == i;
    level.of[i] = first ? static_cast<std::uint32_t>(areas.size()) : level.of[level.of[i]];
    if (first) areas.push_back(0.0f), places.push_back(fine.place(i) / 2);
    areas[level.of[i]] += fine.area(i);
  }

  // Each cell has room for all borders of its parts; then the room is closed.
  std::vector<std::uint32_t> room(areas.size() + 1, 0), used(areas.size(), 0);
  fine.forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t, bool) {
    if (level.of[a] != level.of[b]) ++room[level.of[a] + 1];
  });
  std::partial_sum(room.begin(), room.end(), room.begin());
  std::vector<CellGraph::Border> borders(room.back());
  fine.forEachBorder([&](std::uint32_t a, std::uint32_t b, std::uint32_t border, bool diagonal) {
    const std::uint32_t from = level.of[a], to = level.of[b];
    if (from == to) return;
    const float share = 0.5f * fine.shares()[border], through = share * (open.empty() ? 1.0f : open[border]);
    CellGraph::Border *found = borders.data() + room[from], *const end = found + used[from];
    while (found != end && found->cell != to) ++found;
    if (found == end)
      *found = {to, share, diagonal, through}, ++used[from];
    else
      found->share += share, found->diagonal &= diagonal, found->open += through;
  });
  std::vector<std::uint32_t> first(1, 0);
  std::size_t closed = 0;
  for (std::size_t c = 0; c < areas.size(); ++c) {
    const auto begin = borders.begin() + room[c];
    std::sort(begin, begin + used[c], [](const auto& a, const auto& b) { return a.cell < b.cell; });
    for (auto b = begin; b != begin + used[c]; ++b) b->open /= b->share;
    std::copy(begin, begin + used[c], borders.begin() + static_cast<std::ptrdiff_t>(closed));
    closed += used[c];
    first.push_back(static_cast<std::uint32_t>(closed));
  }
  borders.resize(closed);
  level.graph = CellGraph(std::move(areas), std::move(places), first, borders);
  return level;
}

CellPyramid::Level& CellPyramid::coarse(std::size_t level) {
  while (levels_.size() < level)
    levels_.push_back(coarsened(levels_.empty() ? finest_ : levels_.back().graph, open(levels_.size())));
  return levels_[level - 1];
}

const HeatFlow& CellPyramid::evenFlow(std::size_t level) {
  while (flows_.size() <= level) {
    const CellGraph& g = graph(flows_.size());
    flows_.emplace_back(g, std::vector<float>(g.size(), 1.0f), open(flows_.size()));
  }
  return flows_[level];
}

Channels CellPyramid::restricted(const Channels& values, std::size_t level) {
  const CellGraph &fine = graph(level - 1), &to = graph(level);
  const std::vector<std::uint32_t>& of = coarse(level).of;
  Channels result;
  for (const std::vector<float>& channel : values) {
    std::vector<float>& sums = result.emplace_back(to.size(), 0.0f);
    for (std::size_t i = 0; i < of.size(); ++i) sums[of[i]] += fine.area(i) * channel[i];
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] /= to.area(c);
  }
  return result;
}

Channels CellPyramid::spread(const Channels& values, std::size_t level) {
  const std::vector<std::uint32_t>& of = coarse(level).of;
  Channels result;
  for (const std::vector<float>& channel : values) {
    std::vector<float>& to = result.emplace_back(of.size());
    for (std::size_t i = 0; i < of.size(); ++i) to[i] = channel[of[i]];
  }
  return result;
}

}  // namespace deltalux
