// The solver against exact radiosity on a small room: its error falls with the target.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/render.hpp>

#include "oracle/dense_radiosity.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A closed room with a block in the air, lit by a large lamp under its ceiling: shadows are soft, so that means over
/// patches are measured by a few probes.
Scene roomWithABlock() {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.6f));
  addBox(scene, grey, Vec3(0), {4, 3, 2.5}, true);
  addBox(scene, addMaterial(scene, "dark", lambert(0.3f)), {1.5, 1, 0.4}, {2.5, 2, 1.2}, false);
  addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(3.0f), false, {}}),
             {{1, 0.5, 2.2}, {1, 2.5, 2.2}, {3, 2.5, 2.2}, {3, 0.5, 2.2}});
  return scene;
}

/// Relative error of mean irradiance over the oracle's patches, as the root of the mean square weighted by area.
double errorOf(const SolutionView& solution, const OracleSolution& exact, bool mesh) {
  constexpr int n = 4;
  std::vector<ProbePoint> points;
  for (const OraclePatch& p : exact.patches)
    for (int i = 0; i < n * n; ++i) points.push_back({p.at((i % n + 0.5) / n, (i / n + 0.5) / n), p.normal});
  ProbeSettings settings;
  settings.mesh = mesh, settings.error = 0.005, settings.maxSamples = 1 << 10;
  const auto results = probe(solution, points, settings);
  double squares = 0, area = 0, mean = 0;
  for (std::size_t i = 0; i < exact.patches.size(); ++i) {
    double sum = 0;
    for (int k = 0; k < n * n; ++k) sum += results[i * n * n + k].irradiance.g / (n * n);
    const double difference = sum - exact.irradiance[i];
    squares += exact.patches[i].area * difference * difference;
    area += exact.patches[i].area, mean += exact.patches[i].area * exact.irradiance[i];
  }
  return std::sqrt(squares / area) / (mean / area);
}

TEST(SolveAgainstTheDenseOracle, ErrorFallsInOrderAsTheTargetHalves) {
  const Scene scene = roomWithABlock();
  const OracleSolution exact = solveDense(scene);
  std::vector<double> mesh, probed;
  const std::vector<double> targets{0.4, 0.2, 0.1, 0.05, 0.025};
  for (const double target : targets) {
    SolveSettings settings;
    settings.error = target;
    Engine engine(scene, settings);
    engine.solve();
    mesh.push_back(errorOf(engine.solution(), exact, true));
    probed.push_back(errorOf(engine.solution(), exact, false));
  }
  for (std::size_t i = 1; i < targets.size(); ++i) {
    EXPECT_LT(mesh[i], mesh[i - 1]) << targets[i];
    EXPECT_LT(probed[i], probed[i - 1]) << targets[i];
  }
  for (std::size_t i = 0; i < targets.size(); ++i) EXPECT_LT(probed[i], targets[i]);
}

}  // namespace
}  // namespace deltalux
