// As its error falls, the paper's method comes to the light that lines come to.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "support/residue.hpp"
#include "support/run_cli.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

/// Of irradiance at points over links from that over lines, relative: each point's, and their mean's. Of the ledger:
/// what it does not account for.
struct Distance {
  double median = 0, mean = 0, residue = 0;
};

Engine solveOf(const std::string& scene, double error, SolveMethod method) {
  return test::solved(loadScene({test::bundledScene(scene)}).scene, error, method);
}

Distance distance(const Engine& links, const Engine& lines, const std::vector<ProbePoint>& points) {
  const std::vector<ProbeResult> is = test::measure(links, points), as = test::measure(lines, points);
  std::vector<double> differences;
  double sumOfLinks = 0, sumOfLines = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(test::lux(as[i]) > 0)) continue;  // below a block
    differences.push_back(std::abs(test::lux(is[i]) / test::lux(as[i]) - 1));
    sumOfLinks += test::lux(is[i]), sumOfLines += test::lux(as[i]);
  }
  return {test::spreadOf(std::move(differences)).median, sumOfLinks / sumOfLines - 1,
          test::residue(links.solution().report().energy)};
}

std::vector<Distance> distances(const std::string& scene, const std::vector<double>& errors, double ofLines,
                                const std::vector<ProbePoint>& points) {
  const Engine lines = solveOf(scene, ofLines, SolveMethod::Lines);
  std::vector<Distance> result;
  for (const double error : errors)
    result.push_back(distance(solveOf(scene, error, SolveMethod::Paper), lines, points));
  return result;
}

/// `residue`: what the ledger may not account for at the least error.
void expectToApproach(const std::vector<Distance>& d, double residue) {
  EXPECT_LT(d.back().median, d.front().median);
  EXPECT_LT(d.back().median, 0.02);
  EXPECT_NEAR(d.back().mean, 0, 0.02);
  EXPECT_LT(std::abs(d.back().residue), std::abs(d.front().residue));
  EXPECT_NEAR(d.back().residue, 0, residue);
}

/// n x n points in the middles of equal parts of a rectangle.
std::vector<ProbePoint> gridOn(const Vec3& corner, const Vec3& u, const Vec3& v, const Vec3& normal, int n) {
  std::vector<ProbePoint> points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) points.push_back({corner + (i + 0.5) / n * u + (j + 0.5) / n * v, normal});
  return points;
}

TEST(PaperConvergence, CornellBoxComesToWhatLinesComeTo) {
  std::vector<ProbePoint> points = gridOn({0, 0, 0}, {0.54, 0, 0}, {0, 0, 0.55}, {0, 1, 0}, 8);
  for (const ProbePoint& p : gridOn({0, 0, 0.559}, {0.54, 0, 0}, {0, 0.54, 0}, {0, 0, -1}, 8)) points.push_back(p);
  expectToApproach(distances("cornell/cornell.rad", {0.1, 0.02, 0.005}, 0.01, points), 0.02);
}

TEST(PaperConvergence, LightInTheRingComesToWhatLinesComeTo) {
  const std::vector<ProbePoint> points = gridOn({-0.03, -0.03, 0}, {0.06, 0, 0}, {0, 0.06, 0}, {0, 0, 1}, 12);
  expectToApproach(distances("ring/ring.rad", {0.1, 0.03}, 0.02, points), 0.03);
}

}  // namespace
}  // namespace deltalux
