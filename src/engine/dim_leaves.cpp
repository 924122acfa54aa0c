// Places that light hardly reaches: more lines and shadow rays for their leaves, so that a room behind a slot is no
// matter of chance.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "direct/dim_direct.hpp"
#include "engine/line_solve.hpp"
#include "lines/dim_rooms.hpp"
#include "lines/own_light.hpp"
#include "lines/scene_widths.hpp"
#include "solution/sky_visibility.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kRoomLeaves = 1024, kDimLeaves = 16;  // of a task [task]

/// What the first `counts` lines of leaves say of what others send them [W/m2, gray].
std::vector<float> roughIndirect(const LineSolve& x, const hierarchy::LeafTable& leaves,
                                 std::span<const std::uint32_t> counts, const lines::TracedLines& traced) {
  const std::size_t n = leaves.size();
  std::vector<float> rho(n), source(n);
  const CellOfCode& cellOf = CellOfCode::table();
  parallelFor(n, kRoomLeaves, [&](std::size_t i) {
    const std::size_t leaf = leaves[i].index();
    const hierarchy::ElementLight& l = x.s.elements.radiometry[leaf];
    rho[i] = gray(l.rho + l.tau), source[i] = gray(x.samples.direct[leaf].E + l.particle);
    const std::span<const lines::EscapedLine> escaped = traced.escaped.at(leaves[i]);
    if (x.skies.empty() || escaped.empty()) return;
    // By the mean of each cell of the sky: as rough as a few lines are.
    const std::span<const std::uint32_t> ends = traced.lines.endsOf(leaves[i]);
    const std::span<const lines::LineCode> codes = traced.lines.codesOf(leaves[i]);
    float sky = 0;
    std::uint32_t next = 0, open = 0;
    for (std::uint32_t k = 0; k < counts[i]; ++k) {
      open += ends[k] != lines::kCovered;
      if (ends[k] == lines::kEscaped) sky += gray(escaped[next++].weight) * x.skies.strength(cellOf(codes[k]));
    }
    // Of more lines than these, those that escaped may all come after them.
    if (open > 0) source[i] += std::numbers::pi_v<float> * sky / static_cast<float>(open);
  });
  return lines::ownIndirect(traced.lines, leaves, counts, rho, source);
}

/// Whether a leaf faces what is as wide as a room.
std::vector<char> inRooms(const LineSolve& x, const hierarchy::LeafTable& leaves) {
  const double room = lines::widthsOf(x.s.scene, x.s.elements.sceneBox).room;
  std::vector<char> in(leaves.size(), 0);
  parallelFor(leaves.size(), kRoomLeaves, [&](std::size_t i) {
    const lines::LeafScale& scale = x.samples.scale[leaves[i].index()];
    in[i] = scale.mean > room && std::isfinite(scale.harmonic) && x.takesPart(leaves[i]);
  });
  return in;
}

/// Direct light of leaves that got more lines: from as many points as `counts` of them.
void lightByManyPoints(LineSolve& x, const hierarchy::LeafTable& leaves, std::span<const std::uint32_t> all,
                       std::span<const std::uint32_t> counts, const lines::Lines& lines) {
  x.dim.assign(all.size(), {});
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(all.size(), kDimLeaves, [&](std::size_t n) {
    DimLeaf& dim = x.dim[n];
    dim.leaf = leaves[all[n]];
    std::vector<std::uint32_t> points;
    const std::span<const std::uint32_t> ends = lines.endsOf(dim.leaf).first(counts[all[n]]);
    for (std::uint32_t k = 0; k < ends.size(); ++k) {
      if (ends[k] == lines::kCovered) continue;
      points.push_back(k), dim.points = combineKeys(dim.points, k);
    }
    if (const direct::DimDirect* same =
            x.known ? x.known->dim(x.s.elements, x.s.scene, x.lamps, dim.leaf, dim.points, points) : nullptr) {
      dim.light = *same;
      return std::uint64_t(0);
    }
    dim.light = direct::dimDirect(x.s.elements, x.s.scene, *x.s.tracer, x.lamps, dim.leaf, points);
    return dim.light.rays;
  });
  std::ranges::sort(x.dim, {}, &DimLeaf::leaf);
}

}  // namespace

void lookIntoTheDark(LineSolve& x, const lines::LineScene& over, std::vector<std::uint32_t>& counts,
                     lines::TracedLines& traced) {
  if (!(x.floor > 0)) return;
  const hierarchy::LeafTable& leaves = over.leaves;
  const std::vector<lines::Place> places =
      lines::placesOf(roughIndirect(x, leaves, counts, traced), x.floor, inRooms(x, leaves));
  if (std::ranges::find(places, lines::kDim) == places.end()) return;
  std::vector<float> area(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) area[i] = x.s.elements.shape(leaves[i]).area;
  const std::vector<std::uint32_t> in = lines::waysInto(traced.lines, leaves, counts, places);
  const double all = std::accumulate(counts.begin(), counts.end(), 0.0);
  std::vector<char> more(leaves.size(), false);
  for (int round = 0; round < deltalux::tuning::kEverCloser; ++round) {
    const lines::DimCounts wanted = lines::dimCounts(traced, leaves, counts, all, area, places, in, !x.skies.empty());
    if (std::ranges::all_of(wanted.lines, [](std::uint32_t count) { return count == 0; })) break;
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (wanted.lines[i] > 0) counts[i] = wanted.lines[i], more[i] = true;
    lines::traceLines(over, counts, traced);
    if (wanted.told) break;
  }
  std::vector<std::uint32_t> dim;
  for (std::uint32_t i = 0; i < more.size(); ++i)
    if (more[i]) dim.push_back(i);
  lightByManyPoints(x, leaves, dim, counts, traced.lines);
}

}  // namespace deltalux::engine
