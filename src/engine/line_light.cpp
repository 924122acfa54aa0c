// The light of leaves over lines: sky light by what lines see of it, exchange, iteration to convergence.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/check.hpp"
#include "base/check_interrupted.hpp"
#include "base/parallel.hpp"
#include "base/per_thread.hpp"
#include "engine/line_solve.hpp"
#include "engine/relight.hpp"
#include "lines/line_counts.hpp"
#include "solution/sky_visibility.hpp"

namespace deltalux::engine {

namespace {

constexpr std::size_t kLeaves = 1024, kSkyLeaves = 16;  // of a task [task]
constexpr double kWidest = 8;                           // standard errors, beyond which no error lies [limit]
constexpr int kSteps = 24;                              // of a bisection [rounding]
constexpr int kErrorSteps = 64 * 20;                    // of errors of leaves, in 64ths of an octave [layout]

/// What each leaf sends of the light of its sources but for skies, at their nominal scales [W, gray].
std::vector<float> powerOf(const LineSolve& x, const hierarchy::LeafTable& leaves) {
  std::vector<float> power(leaves.size());
  parallelFor(leaves.size(), kLeaves, [&](std::size_t i) {
    const std::size_t e = leaves[i].index();
    const hierarchy::ElementLight& l = x.s.elements.radiometry[e];
    power[i] = x.s.elements.geometry[e].area * gray((l.rho + l.tau) * (x.samples.direct[e].E + l.particle));
  });
  return power;
}

/// Sky light of every leaf, undimmed; that of leaves which nothing has changed for is that from before, in `sky`.
KnownSky skyOf(LineSolve& x, const hierarchy::LeafTable& leaves, const lines::TracedLines& traced, KnownSky sky) {
  constexpr std::size_t kEach = LeafSky::kRays;
  const bool sameSkies = std::exchange(sky.skies, x.skies.key()) == x.skies.key();
  sky.at.assign(leaves.size(), {});
  const std::optional<direct::SkyVisibility> was = std::exchange(sky.visibility, {});
  if (x.skies.empty()) {  // nobody looks after shadow rays to none
    sky.of.clear();
    return sky;
  }
  sky.of.resize(x.s.elements.size());
  const lines::KnownLines* before = x.knownLines ? &*x.knownLines : nullptr;
  const direct::SkyVisibility& visibility =
      sky.visibility.emplace(skyVisibility(x.s.elements, leaves, traced.lines, was ? &*was : nullptr, before));
  struct Scratch {
    std::vector<direct::EscapedView> escaped;
    std::vector<std::uint32_t> points;
  };
  PerThread<Scratch> scratch;
  x.s.report.counts.raysVisibility += parallelSum<std::uint64_t>(leaves.size(), kSkyLeaves, [&](std::size_t i) {
    const lines::LineRange& own = traced.lines.at(leaves[i]);
    std::unique_ptr<LeafSky>& known = sky.of[leaves[i].index()];
    if (!before || !before->stands[leaves[i].index()] || own.open() == 0) known.reset();
    if (own.open() == 0) return std::uint64_t(0);
    // Of the same lines, and the same estimate, all follows again.
    const bool same = known && sameSkies && before->same(leaves[i], traced.lines) &&
                      known->key.guide == visibility.key(static_cast<std::uint32_t>(i));
    auto& [escaped, points] = scratch.local();
    points.clear();
    // Where lines are so many that they would be their own guides, what they have found by chance would count less.
    const std::size_t rays = own.count < direct::kGuideLines ? kEach : 0;
    const std::span<const std::uint32_t> ends = traced.lines.endsOf(own);
    for (std::uint32_t k = 0; k < ends.size() && points.size() < rays; ++k)
      if (ends[k] != lines::kCovered) points.push_back(k);
    const auto viewLines = [&] {
      escaped.clear();
      for (const lines::EscapedLine& e : traced.escaped.at(leaves[i]))
        escaped.push_back({e.direction, e.cosine, e.weight, e.chance});
      return direct::SkyLeaf{static_cast<std::uint32_t>(i), leaves[i], own.open(), escaped, points};
    };
    std::optional<direct::SkyLeaf> leaf;
    if (!same) leaf = viewLines();
    const direct::SkyKey key = same ? known->key : direct::skyKey(x.skies, visibility, *leaf);
    std::array<direct::SkyRay, kEach> ran{};
    const std::span<direct::SkyRay> shadow = std::span(ran).first(points.size());
    if (known && known->key.points == key.points && x.known->holdSkyRays(x.s.elements, leaves[i], *known, shadow) &&
        known->key.light == key.light) {
      known->key = key, sky.at[i] = known->light;
      return std::uint64_t(0);
    }
    if (!leaf) leaf = viewLines();
    const direct::SkyAtLeaf light =
        direct::skyLight(x.skies, visibility, x.s.elements, x.s.scene, *x.s.tracer, *leaf, shadow);
    auto now = std::make_unique<LeafSky>(LeafSky{key, light});
    for (std::size_t k = 0; k < shadow.size(); ++k) {
      now->cells[k] = shadow[k].cell;
      if (shadow[k].traced())
        now->rays[k] = lines::lineCode(shadow[k].direction, shadow[k].length);
      else if (shadow[k].known != direct::SkyRay::Visibility::Unknown)
        now->rays[k] = known->rays[k];
    }
    known = std::move(now), sky.at[i] = light;
    return std::uint64_t(light.rays);
  });
  return sky;
}

/// Indirect light of a leaf, to begin with: that from before, or the coarse light. (That itself begins with none: by it
/// the mesh is refined, and what iteration leaves would decide.)
Rgb startOf(const LineSolve& x, hierarchy::ElementId leaf) {
  if (const auto before = x.known ? x.known->indirect(x.s.elements, leaf) : std::nullopt) return *before;
  return x.s.elements.radiometry[hierarchy::surfaceOf(x.s.elements, leaf).index()].indirect;
}

/// What is exchanged over the lines: what was known of it follows the changed ones.
std::unique_ptr<lines::Exchange> exchangeOf(LineSolve& x, const hierarchy::LeafTable& leaves,
                                            const lines::Lines& traced) {
  std::unique_ptr<lines::Exchange> exchange = std::move(x.exchange);
  if (!exchange || !x.knownLines) return std::make_unique<lines::Exchange>(traced, x.s.elements, leaves, x.tracer);
  exchange->follow(*x.knownLines, traced, x.s.elements, leaves, x.tracer);
  return exchange;
}

}  // namespace

lines::TracedLines traceLeaves(LineSolve& x, std::uint32_t base, TakeLines takeLines, Progress* progress) {
  const hierarchy::Elements& elements = x.s.elements;
  const hierarchy::LeafTable leaves(elements);
  x.dim.clear();
  std::vector<std::uint32_t> counts = lines::lineCounts(elements, leaves, powerOf(x, leaves), x.enclosed, base);
  const hierarchy::LeafLocator locator(elements, x.s.scene, leaves);
  lines::TracedLines traced;
  if (x.known) x.knownLines = (x.known->*takeLines)(elements, traced);
  const lines::LineScene over{elements, leaves,     locator,         x.tracer,
                              x.cover,  x.enclosed, x.samples.first, x.knownLines ? &*x.knownLines : nullptr};
  lines::traceLines(over, counts, traced);
  checkInterrupted(progress);
  lookIntoTheDark(x, over, counts, traced);
  lines::trim(leaves, counts, traced);
  DELTALUX_VALIDATED(validate(traced.lines));
  x.s.report.counts.raysVisibility += std::exchange(traced.rays, 0);
  return traced;
}

void lightLeaves(LineSolve& x, lines::TracedLines traced, const Dimming& dimming, double converged,
                 Progress* progress) {
  Solution& s = x.s;
  const hierarchy::LeafTable leaves(s.elements);
  checkInterrupted(progress);
  x.exchange = exchangeOf(x, leaves, traced.lines);
  checkInterrupted(progress);
  x.sky = skyOf(x, leaves, traced, std::move(x.sky));
  checkInterrupted(progress);
  parallelFor(leaves.size(), kLeaves, [&](std::size_t i) {
    s.elements.radiometry[leaves[i].index()].indirect = x.floor > 0 ? startOf(x, leaves[i]) : Rgb(0.0f);
  });
  relight(s, leaves, *x.exchange, lampsOf(x.samples, x.dim, leaves), x.sky, dimming, converged);
  s.lines = std::move(traced.lines), x.escaped = std::move(traced.escaped), x.bends = std::move(traced.bends);
  s.report.counts.lines = s.lines.size();
  s.report.memory.lines = s.lines.memoryBytes() + x.exchange->memoryBytes();
}

ErrorEstimate estimateError(const Solution& s) {
  const double floor = floorOf(s.elements);
  struct Leaf {
    double error, area;
  };
  const hierarchy::LeafTable leaves(s.elements);
  std::vector<Leaf> all;
  double area = 0, widest = 0;
  for (std::size_t i = 0; i < leaves.size() && i < s.deviation.size(); ++i) {
    const hierarchy::ElementLight& l = s.elements.radiometry[leaves[i].index()];
    const double E = gray(l.direct + l.indirect + l.particle), A = s.elements.shape(leaves[i]).litArea();
    if (s.lines.countOf(leaves[i]) == 0 || !(E > 0)) continue;
    all.push_back({s.deviation[i] / std::max(E, floor), A});
    area += A, widest = std::max(widest, all.back().error);
  }
  // The errors of leaves are as good as normal: within how much a share of all area lies. Errors that are the same
  // within a 64th of an octave count together.
  std::vector<Leaf> steps(kErrorSteps);
  for (const Leaf& leaf : all) {
    const double below = leaf.error > 0 ? 64 * std::log2(widest / leaf.error) : kErrorSteps - 1.0;
    // In this order the last step takes an error that is no number, too.
    Leaf& step = steps[static_cast<std::size_t>(std::min(kErrorSteps - 1.0, below))];
    step.error += leaf.area * leaf.error, step.area += leaf.area;
  }
  std::erase_if(steps, [](const Leaf& step) { return !(step.area > 0); });
  for (Leaf& step : steps) step.error /= step.area;
  const auto quantile = [&](double share) -> std::optional<double> {
    if (all.empty()) return {};
    double low = 0, high = kWidest * widest;
    for (int step = 0; step < kSteps; ++step) {
      const double middle = 0.5 * (low + high);
      double within = 0;
      for (const Leaf& leaf : steps)
        within += leaf.area * (leaf.error > 0 ? std::erf(middle / (std::numbers::sqrt2 * leaf.error)) : 1.0);
      (within < share * area ? low : high) = middle;
    }
    return high;
  };
  return {s.settings.error, quantile(0.5), quantile(0.95)};
}

}  // namespace deltalux::engine
