// Places that light hardly reaches: more lines and shadow rays for their leaves, so that a room behind a slot is no
// matter of chance.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/parallel.hpp"
#include "direct/dim_direct.hpp"
#include "engine/line_solve.hpp"
#include "lines/dim_rooms.hpp"
#include "lines/own_light.hpp"
#include "lines/tuning.hpp"
#include "solution/sky_visibility.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kRoomLeaves = 1024, kDimLeaves = 16;  // of a task [task]

/// What the leaves' own lines say of what others send them [W/m2, gray].
std::vector<float> roughIndirect(const LineSolve& x, const hierarchy::LeafTable& leaves,
                                 const lines::TracedLines& traced) {
  const std::size_t n = leaves.size();
  std::vector<float> rho(n), source(n);
  const std::vector<std::uint32_t> firstEscaped = lines::firstOf(traced.escaped, n);
  const CellOfCode& cellOf = CellOfCode::table();
  parallelFor(n, kRoomLeaves, [&](std::size_t i) {
    const std::size_t leaf = leaves[i].index();
    const hierarchy::ElementLight& l = x.s.elements.radiometry[leaf];
    rho[i] = gray(l.rho + l.tau), source[i] = gray(x.samples.direct[leaf].E + l.particle);
    if (x.skies.empty() || firstEscaped[i] == firstEscaped[i + 1]) return;
    // By the mean of each cell of the sky: as rough as a few lines are.
    float sky = 0;
    std::uint32_t escaped = firstEscaped[i];
    for (std::uint64_t k = traced.lines.first[i]; k < traced.lines.first[i + 1]; ++k)
      if (traced.lines.end[k] == lines::kEscaped)
        sky += gray(traced.escaped[escaped++].weight) * x.skies.strength(cellOf(traced.lines.code[k]));
    source[i] += std::numbers::pi_v<float> * sky / static_cast<float>(traced.lines.countOf(i) - traced.covered[i]);
  });
  return lines::ownIndirect(traced, rho, source);
}

/// Whether a leaf faces what is as wide as a room.
std::vector<char> inRooms(const LineSolve& x, const hierarchy::LeafTable& leaves) {
  const double room = std::min(lines::tuning::kDimRoom / x.s.scene.metresPerUnit,
                               lines::tuning::kSlotOfScene * x.s.elements.sceneBox.diagonal());
  std::vector<char> in(leaves.size(), 0);
  parallelFor(leaves.size(), kRoomLeaves, [&](std::size_t i) {
    const lines::LeafScale& scale = x.samples.scale[leaves[i].index()];
    in[i] = scale.mean > room && std::isfinite(scale.harmonic) && x.takesPart(leaves[i]);
  });
  return in;
}

/// Direct light of leaves that got more lines: from as many points.
void lightByManyPoints(LineSolve& x, const hierarchy::LeafTable& leaves, const lines::Lines& lines) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < leaves.size(); ++i)
    if (lines.countOf(i) > 0) all.push_back(i);
  x.dim.assign(all.size(), {});
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(all.size(), kDimLeaves, [&](std::size_t n) {
    const std::uint32_t i = all[n];
    DimLeaf& dim = x.dim[n];
    dim.leaf = leaves[i];
    std::vector<std::uint32_t> points;
    for (std::uint32_t k = 0; k < lines.countOf(i); ++k) {
      if (lines.end[lines.first[i] + k] == lines::kCovered) continue;
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

lines::TracedLines lookIntoTheDark(LineSolve& x, const lines::LineScene& over, lines::TracedLines traced) {
  if (!(x.floor > 0)) return traced;
  const hierarchy::LeafTable& leaves = over.leaves;
  const std::vector<lines::Place> places =
      lines::placesOf(roughIndirect(x, leaves, traced), x.floor, inRooms(x, leaves));
  if (std::ranges::find(places, lines::kDim) == places.end()) return traced;
  std::vector<float> area(leaves.size());
  for (std::size_t i = 0; i < leaves.size(); ++i) area[i] = x.s.elements.shape(leaves[i]).area;
  const std::vector<std::uint32_t> in = lines::waysInto(traced, places);
  std::optional<lines::TracedLines> more;
  for (int round = 0; round < lines::tuning::kDimRounds; ++round) {
    const lines::DimCounts counts =
        lines::dimCounts(traced, area, places, in, !x.skies.empty(), more ? &*more : nullptr);
    if (std::ranges::all_of(counts.lines, [](std::uint32_t count) { return count == 0; })) break;
    lines::TracedLines next = lines::traceLines(over, counts.lines);
    more = more ? lines::replaced(*more, next) : std::move(next);
    if (counts.told) break;
  }
  if (!more) return traced;
  lightByManyPoints(x, leaves, more->lines);
  return lines::replaced(traced, *more);
}

}  // namespace deltalux::engine
