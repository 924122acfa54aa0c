#include <algorithm>
#include <cmath>
#include <deltalux/check.hpp>
#include <deltalux/render.hpp>

#include "base/sobol.hpp"
#include "base/tuning.hpp"
#include "hierarchy/patch.hpp"
#include "solution/solution.hpp"

namespace deltalux {

namespace {

std::vector<ProbePoint> pointsByArea(const Solution& s, std::size_t count) {
  std::vector<double> cumulative;
  std::vector<hierarchy::ElementId> leaves;
  double area = 0;
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    const hierarchy::ElementTopology& t = s.elements.topology[i];
    if (t.kind != hierarchy::ElementKind::Patch || t.childCount > 0 || t.emitter || t.blocker) continue;
    cumulative.push_back(area += s.elements.geometry[i].area);
    leaves.emplace_back(i);
  }
  std::vector<ProbePoint> points;
  for (std::uint32_t i = 0; i < count && area > 0; ++i) {
    const auto at = std::lower_bound(cumulative.begin(), cumulative.end(), (i + 0.5) / double(count) * area);
    const hierarchy::ElementId leaf = leaves[std::min<std::size_t>(at - cumulative.begin(), leaves.size() - 1)];
    const UnitPair u = scrambledSobol(i, 11);
    const hierarchy::PatchPoint p = hierarchy::samplePatch(s.elements, s.scene, leaf, u.x, u.y);
    points.push_back({Vec3(p.position), Vec3(p.normal)});
  }
  return points;
}

}  // namespace

CheckReport compareSolutions(const SolutionView& updated, const SolutionView& fresh, const CheckSettings& settings,
                             Progress* progress) {
  const std::vector<ProbePoint> points = pointsByArea(fresh.get(), settings.points);
  ProbeSettings meter;
  meter.error = settings.error;
  const auto a = probe(updated, points, meter, progress), b = probe(fresh, points, meter, progress);
  const auto gray = [](const ProbeResult& r) { return deltalux::gray(RgbSum(r.irradiance)); };
  double mean = 0;
  for (const ProbeResult& r : b) mean += gray(r) / double(points.size());
  std::vector<double> differences;
  for (std::size_t i = 0; i < points.size(); ++i)
    differences.push_back(std::abs(gray(a[i]) - gray(b[i])) /
                          std::max({gray(b[i]), double(tuning::kNegligible) * mean, 1e-30}));
  std::sort(differences.begin(), differences.end());
  CheckReport check;
  if (!differences.empty()) {
    check.medianRelDiff = differences[differences.size() / 2];
    check.p95RelDiff = differences[differences.size() * 95 / 100];
    check.maxRelDiff = differences.back();
  }
  const SolutionHashes mine = hashesOf(updated.get()), theirs = hashesOf(fresh.get());
  check.meshIdentical = mine.mesh == theirs.mesh;
  check.linesIdentical = mine.lines == theirs.lines;
  check.particlesIdentical = mine.particles == theirs.particles;
  return check;
}

}  // namespace deltalux
