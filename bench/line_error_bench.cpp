// line_error_bench NAME SCENE ERROR...
//
// The error that was asked for, the one that a solve's report estimates, and the one there is, as CSV rows: scene,
// asked, seconds, leaves, lines, and median and 95th percentile of both, relative, by area. What there is: the
// irradiance of 300 leaves, drawn by area, against the mean of meters at 64 points of each, which gather by lines and
// shadow rays of their own and of which it is known how they stand to independent values (suite `lines`).
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>
#include <stdexcept>

#include "base/random.hpp"
#include "direct/tuning.hpp"
#include "hierarchy/leaf_sequence.hpp"
#include "lines/cover.hpp"
#include "run_main.hpp"
#include "solution/solution.hpp"

namespace deltalux::bench {
namespace {

constexpr std::size_t kLeaves = 300, kPoints = 64;
constexpr std::uint32_t kFirstPoint = 4096;  // of a leaf's sequence: none that the solve has used
constexpr double kMeterError = 0.04;         // a quarter of which a meter's own may be

float irradianceOf(const hierarchy::ElementLight& l) { return gray(l.direct + l.indirect + l.particle); }

struct Sampled {
  std::vector<std::size_t> leaves;
  double floor = 0;  // light that still matters [W/m2]
};

/// Leaves with light, by area.
Sampled sampleLeaves(const Solution& s, const hierarchy::LeafTable& all) {
  std::vector<double> area;
  double sum = 0, light = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double E = irradianceOf(s.elements.radiometry[all[i].index()]);
    const double A = s.lines.countOf(all[i]) > 0 && E > 0 ? double(s.elements.geometry[all[i].index()].litArea()) : 0.0;
    sum += A, light += A * E, area.push_back(sum);
  }
  Sampled sampled{{}, direct::tuning::kFloor * light / sum};
  Rng random(kLeaves, kPoints);
  for (std::size_t k = 0; k < kLeaves; ++k) {
    const double at = sum * (static_cast<double>(k) + random.uniform()) / kLeaves;
    sampled.leaves.push_back(
        static_cast<std::size_t>(std::lower_bound(area.begin(), area.end() - 1, at) - area.begin()));
  }
  return sampled;
}

/// Relative errors of the sampled leaves, ascending.
std::vector<double> errorsOf(const SolutionView& view) {
  const Solution& s = view.get();
  const hierarchy::LeafTable all(s.elements);
  const lines::Cover cover(s.scene, *s.tracer);
  const Sampled sampled = sampleLeaves(s, all);
  std::vector<ProbePoint> points;
  for (const std::size_t leaf : sampled.leaves) {
    const hierarchy::LeafSequence sequence(s.elements, s.scene, all[leaf]);
    const PrimitiveId own = s.elements.domain[all[leaf].index()].primitive;
    const lines::Cover::About about = cover.about(s.elements, all[leaf]);
    std::uint64_t rays = 0;
    std::uint32_t i = kFirstPoint;
    for (std::size_t k = 0; k < kPoints; ++i) {
      const hierarchy::PatchPoint x = sequence.point(i);
      if (i < 2 * kFirstPoint && cover.covers(x.position, x.normal, own, about, rays)) continue;
      points.push_back({Vec3(x.position), Vec3(x.normal)}), ++k;
    }
  }
  ProbeSettings settings;
  settings.error = kMeterError;
  const std::vector<ProbeResult> meters = probe(view, points, settings);
  std::vector<double> errors;
  for (std::size_t k = 0; k < kLeaves; ++k) {
    double mean = 0;
    for (std::size_t p = 0; p < kPoints; ++p) mean += gray(Rgb(meters[k * kPoints + p].irradiance)) / kPoints;
    const double E = irradianceOf(s.elements.radiometry[all[sampled.leaves[k]].index()]);
    errors.push_back(std::abs(E - mean) / std::max(mean, sampled.floor));
  }
  std::sort(errors.begin(), errors.end());
  return errors;
}

int run(const std::vector<std::string>& a) {
  if (a.size() < 3) throw std::runtime_error("usage: NAME SCENE ERROR...");
  for (std::size_t i = 2; i < a.size(); ++i) {
    SolveSettings settings;
    settings.error = std::atof(a[i].c_str());
    Engine engine(loadScene({a[1]}).scene, settings);
    const SolveReport report = engine.solve();
    const std::vector<double> errors = errorsOf(engine.solution());
    fmt::print("{},{},{:.3g},{},{},{:.3g},{:.3g},{:.3g},{:.3g}\n", a[0], settings.error, report.times.total,
               report.counts.leafElements, report.counts.lines, report.error.estimatedMedian.value_or(0),
               errors[errors.size() / 2], report.error.estimatedP95.value_or(0), errors[errors.size() * 95 / 100]);
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  return deltalux::bench::runMain("line_error_bench", argc, argv, deltalux::bench::run);
}
