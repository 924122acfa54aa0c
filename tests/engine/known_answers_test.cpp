// Scenes of known answer through the solver: plates, the Cornell box, sums of lights, turned scenes.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "support/plates.hpp"
#include "support/reference_values.hpp"
#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr double kTolerance = 0.01;

TEST(SolvedPlates, FormFactorsAreTheirClosedForms) {
  for (const Plates& p : kPlates)
    EXPECT_NEAR(factorOf(p, [](Scene s) { return solved(std::move(s)); }) / p.factor, 1, kTolerance) << p.name;
}

/// A furnished corner: irregular enough that axes matter to the boxes of clusters.
Scene furnished(float first, float second) {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.7f));
  addBox(scene, white, Vec3(0), {3, 2.5, 2.2}, true);
  addBox(scene, addMaterial(scene, "red", Opaque{Rgb(0.6f, 0.2f, 0.1f), {}, {}}), {0.8, 0.7, 0}, {1.4, 1.5, 0.9},
         false);
  addShape(scene, white, Sphere{{2.2, 1.2, 0.5}, 0.3, false});
  const auto lamp = [&](float radiance, double x) {
    if (radiance > 0)
      addPolygon(scene, addMaterial(scene, "lamp", lambert(0), Emission{Rgb(radiance), false, {}}),
                 {{x, 1, 2.15}, {x, 1.4, 2.15}, {x + 0.4, 1.4, 2.15}, {x + 0.4, 1, 2.15}});
  };
  lamp(first, 0.5), lamp(second, 2.1);
  return scene;
}

std::vector<ProbePoint> metersIn(const Scene& scene) {
  std::vector<ProbePoint> points;
  for (std::size_t i = 0; i < 13; ++i)  // walls, block, ball
    for (const double u : {0.13, 0.41, 0.67, 0.91})
      for (const double v : {0.22, 0.58, 0.86}) {
        const SurfacePoint p = pointAt(scene.primitives[i].shape, {u, v});
        if (p.position.z > 1e-6) points.push_back({p.position, p.normal});  // not under the block
      }
  return points;
}

TEST(Solve, TheSolutionOfTwoLightsIsTheSumOfTheirs) {
  const Scene both = furnished(12, 5);
  const auto points = metersIn(both);
  const auto first = measure(solved(furnished(12, 0), 0.05), points),
             second = measure(solved(furnished(0, 5), 0.05), points), sum = measure(solved(both, 0.05), points);
  std::vector<double> differences;
  for (std::size_t i = 0; i < points.size(); ++i)
    differences.push_back(std::abs(gray(first[i].irradiance + second[i].irradiance) - gray(sum[i].irradiance)) /
                          gray(sum[i].irradiance));
  const Spread spread = spreadOf(differences);
  EXPECT_LT(spread.median, 0.01);
  EXPECT_LT(spread.p95, 0.05);
}

TEST(Solve, RotatedScenesHaveRotatedSolutions) {
  const Scene upright = furnished(12, 0);
  const Mat4 turn =
      glm::translate(glm::rotate(glm::rotate(Mat4(1), 0.7, Vec3(1, 2, 0.5)), -1.1, Vec3(0, 1, 3)), Vec3(5, -2, 7));
  Scene turned = upright;
  for (Primitive& p : turned.primitives) p.shape = transformed(p.shape, turn).value();
  std::vector<ProbePoint> points = metersIn(upright), there = points;
  for (ProbePoint& p : there) p = {Vec3(turn * glm::dvec4(p.position, 1)), glm::dmat3(turn) * p.normal};
  const auto a = measure(solved(upright, 0.05), points), b = measure(solved(turned, 0.05), there);
  std::vector<double> differences;
  for (std::size_t i = 0; i < a.size(); ++i)
    differences.push_back(std::abs(gray(a[i].irradiance) - gray(b[i].irradiance)) / gray(a[i].irradiance));
  const Spread spread = spreadOf(differences);
  EXPECT_LT(spread.median, 0.01);
  EXPECT_LT(spread.p95, 0.05);
}

TEST(SolvedCornell, ProbesAgreeWithTheReferenceValues) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const auto expected = readReferenceValues(shared / "reference/cornell.csv");
  std::vector<ProbePoint> points;
  for (const ReferenceValue& v : expected) points.push_back(v.point);
  const std::tuple<double, double, double> limits[] = {{0.05, 0.02, 0.08}, {0.02, 0.01, 0.04}};
  for (const auto& [error, median, p95] : limits) {
    const auto results =
        probe(solved(loadScene({bundledScene("cornell/cornell.rad")}).scene, error).solution(), points);
    std::vector<double> differences;
    for (std::size_t i = 0; i < points.size(); ++i)
      differences.push_back(std::abs(gray(results[i].irradiance) / gray(expected[i].irradiance) - 1));
    const Spread spread = spreadOf(differences);
    EXPECT_LT(spread.median, median) << error;
    EXPECT_LT(spread.p95, p95) << error;
  }
}

}  // namespace
}  // namespace deltalux
