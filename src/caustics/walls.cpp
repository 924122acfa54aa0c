#include "caustics/walls.hpp"

#include <algorithm>
#include <array>

#include "base/tuning.hpp"
#include "caustics/tuning.hpp"
#include "caustics/vector_math.hpp"

namespace deltalux::caustics {

namespace {

constexpr float kTinyWeight = 1e-30f;    // [rounding]
constexpr std::size_t kSlotChunk = 256;  // slots whose numbers stay close by [task]

/// Of all slots, each with the kernel that holds so many.
struct Estimates {
  Slots root;     // of E
  Slots overlap;  // of the kernel, times the mean cell's area
  Slots noise;    // variance of 2 sqrt E
};

/// Between the two levels that hold fewer and more, which counts and overlaps tell on a logarithmic scale.
void estimateChunk(const std::vector<ScaleLevel>& levels, double area, std::size_t begin, std::size_t count,
                   Estimates& to) {
  constexpr float few = 0.1f;
  const auto wanted = static_cast<float>(deltalux::tuning::kFewestEstimates);
  float before[kSlotChunk], estimate[kSlotChunk], level[kSlotChunk], grain[kSlotChunk], open[kSlotChunk],
      last[kSlotChunk];
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const float *light = levels[k].light[0].data() + begin, *squares = levels[k].light[1].data() + begin;
    const auto overlap = static_cast<float>(levels[k].overlap * area), log = std::log(overlap);
    const float logBefore = k > 0 ? static_cast<float>(std::log(levels[k - 1].overlap * area)) : log;
    const bool first = k == 0;
    for (std::size_t i = 0; i < count; ++i) {
      const float E = std::max(light[i], 0.0f), square = std::max(squares[i], kTinyWeight);
      const float holds = std::max(E * E / (square * overlap), few);
      const bool takes = first || open[i] > 0, between = !first && holds > wanted && before[i] < wanted;
      const float t = between ? (logOf(wanted) - logOf(before[i])) / (logOf(holds) - logOf(before[i])) : 1.0f;
      const float mixed = first ? E : t * E + (1 - t) * last[i];
      estimate[i] = takes ? mixed : estimate[i];
      level[i] = takes ? t * log + (1 - t) * logBefore : level[i];
      grain[i] = takes ? (E > 0 ? square / E : 0.0f) : grain[i];
      open[i] = holds < wanted && takes ? 1.0f : 0.0f;
      before[i] = holds, last[i] = E;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    to.root[begin + i] = std::sqrt(std::max(estimate[i], 0.0f));
    to.overlap[begin + i] = expOf(level[i]);
    to.noise[begin + i] = std::max(grain[i] * expOf(level[i]), kTinyWeight);
  }
}

Estimates estimatesOf(const CellRaster& raster, const std::vector<ScaleLevel>& levels) {
  Estimates result{Slots(raster.slots(), 0.0f), Slots(raster.slots(), 1.0f), Slots(raster.slots(), 1.0f)};
  const std::size_t end = raster.rowBegin(raster.rows());
  for (std::size_t begin = raster.rowBegin(0); begin < end; begin += kSlotChunk)
    estimateChunk(levels, raster.meanArea(), begin, std::min(kSlotChunk, end - begin), result);
  for (Slots* s : {&result.root, &result.overlap, &result.noise}) raster.closeRows(*s);
  return result;
}

/// The middle one of nine.
inline float medianOf(float a, float b, float c, float d, float e, float f, float g, float h, float i) {
  const auto sort = [](float& x, float& y) {
    const float low = std::min(x, y);
    y = std::max(x, y), x = low;
  };
  sort(b, c), sort(e, f), sort(h, i), sort(a, b), sort(d, e), sort(g, h), sort(b, c), sort(e, f), sort(h, i);
  sort(a, d), sort(f, i), sort(e, h), sort(d, g), sort(b, e), sort(c, f), sort(e, h), sort(e, c), sort(g, e);
  sort(e, c);
  return e;
}

/// The middle ones of all slots' values and their neighbours', and at least 0. Those that do not exist are very much or
/// very little in turn.
Slots mediansAround(const CellRaster& raster, const Slots& E) {
  constexpr float much = 1e30f;
  Slots result(E.size(), 0.0f), areas = raster.areas();
  raster.closeRows(areas);
  const std::size_t S = raster.stride(), begin = raster.rowBegin(0), end = raster.rowBegin(raster.rows());
  const float *value = E.data(), *area = areas.data();
  float* const to = result.data();
  for (std::size_t i = begin; i < end; ++i) {
    const auto at = [&](std::size_t k, float otherwise) { return area[k] > 0 ? value[k] : otherwise; };
    const float middle =
        medianOf(at(i - S - 1, much), at(i - S, -much), at(i - S + 1, much), at(i - 1, -much), value[i],
                 at(i + 1, -much), at(i + S - 1, much), at(i + S, -much), at(i + S + 1, much));
    to[i] = std::max(middle, 0.0f);
  }
  raster.closeRows(result);
  return result;
}

/// By border: exp(-x / contrast^2), x = squared(slot, slot), halved over diagonals: the cells are further apart.
template <class Squared>
Borders edgeStopping(const CellRaster& raster, double contrast, const Squared& squared) {
  Borders stopping;
  const std::size_t begin = raster.rowBegin(0), end = raster.rowBegin(raster.rows());
  for (std::size_t b = 0; b < stopping.size(); ++b) {
    stopping[b].assign(raster.slots(), 1.0f);
    const auto factor = static_cast<float>((b < 2 ? 1 : 0.5) / (contrast * contrast));
    const std::size_t across = raster.across()[b];
    float* const to = stopping[b].data();
    for (std::size_t i = begin; i < end; ++i)
      to[i] = std::max(deltalux::tuning::kNegligible, expOf(-factor * squared(i, i + across)));
  }
  return stopping;
}

}  // namespace

EdgeStopping blurredWalls(const CellRaster& raster, const Channels& light) {
  const HeatFlow even(raster, {});
  ScaleSpace space(raster, even, light);
  while (space.widen()) {
  }
  const Estimates estimates = estimatesOf(raster, space.levels());
  const float *root = estimates.root.data(), *overlap = estimates.overlap.data(), *noise = estimates.noise.data();
  EdgeStopping walls;
  walls.bandwidth.resize(raster.slots());
  const auto half = static_cast<float>(raster.meanArea() / (8 * kPi));
  for (std::size_t i = 0; i < raster.slots(); ++i) walls.bandwidth[i] = half / overlap[i];
  constexpr auto cell = static_cast<float>(4 * kPi);
  walls.stopping = edgeStopping(raster, tuning::kConfidence, [=](std::size_t a, std::size_t b) {
    const float jump = 2 * (root[a] - root[b]);
    // Over the kernel's width, not over the one cell.
    const float widths = std::max(1 / (cell * std::max(overlap[a], overlap[b])), 0.25f);
    return jump * jump * widths / std::max(noise[a], noise[b]);
  });
  return walls;
}

Borders sharpWalls(const CellRaster& raster, const Slots& E, double darkness) {
  Slots roots = mediansAround(raster, E);
  const auto least = static_cast<float>(darkness);
  for (float& r : roots) r = std::sqrt(r + least);
  const float* const root = roots.data();
  const auto noise = static_cast<float>(2 * std::sqrt(deltalux::tuning::kPilots));
  return edgeStopping(raster, tuning::kSharp, [=](std::size_t a, std::size_t b) {
    const float jump = noise * (1 - std::min(root[a], root[b]) / std::max(std::max(root[a], root[b]), kTinyWeight));
    return jump * jump;
  });
}

}  // namespace deltalux::caustics
