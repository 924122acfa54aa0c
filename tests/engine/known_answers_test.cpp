// Scenes of known answer through the solver: plates, CIE 171, sums of lights.
#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/render.hpp>

#include "solution/solution.hpp"
#include "support/rooms.hpp"
#include "support/run_cli.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr double kTolerance = 0.01;

double lux(const ProbeResult& r) { return photometric(r.irradiance); }
Rgb fromPhotometric(double value) { return Rgb(static_cast<float>(value / kLuminousEfficacy)); }

Engine solved(Scene scene, double error = 0.01) {
  SolveSettings settings;
  settings.error = error;
  Engine engine(std::move(scene), settings);
  engine.solve();
  return engine;
}

/// Shadow rays until their own error is a fraction of the tolerance.
std::vector<ProbeResult> measure(const Engine& engine, const std::vector<ProbePoint>& points) {
  ProbeSettings settings;
  settings.error = 0.002, settings.maxSamples = 1 << 16;
  return probe(engine.solution(), points, settings);
}

/// Area mean of E over the leaves on one side of a primitive, and its area. [W/m2]
double meshMean(const Engine& engine, PrimitiveId primitive) {
  const Elements& e = engine.solution().get().elements;
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < e.size(); ++i) {
    const ElementTopology& t = e.topology[i];
    if (t.kind != ElementKind::Patch || t.emitter || t.childCount > 0 || !t.front) continue;
    if (e.domain[i].primitive != primitive) continue;
    sum += double(e.geometry[i].area) * gray(e.radiometry[i].direct + e.radiometry[i].indirect);
    area += e.geometry[i].area;
  }
  return sum / area;
}

TEST(SolvedPlates, FormFactorsAreTheirClosedForms) {
  const std::pair<const char*, double> plates[] = {{"plates/parallel.rad", 0.1998249},
                                                   {"plates/perpendicular.rad", 0.2000436}};
  for (const auto& [name, factor] : plates) {
    Scene scene = loadScene({bundledScene(name)}).scene;
    PrimitiveId receiver;
    double M = 0;
    for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
      const auto& emission = scene.materialOf(PrimitiveId(i)).emission;
      if (emission)
        M = kPi * gray(emission->radiance);
      else
        receiver = PrimitiveId(i);
    }
    EXPECT_NEAR(meshMean(solved(std::move(scene)), receiver) / M / factor, 1, kTolerance) << name;
  }
}

Scene blackRoom(double height = 3) {
  Scene scene;
  addBox(scene, addMaterial(scene, "black", lambert(0)), Vec3(0), {4, 4, height}, true);
  return scene;
}

TEST(SolvedCie171, Case53AreaSource) {
  Scene scene = blackRoom();
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0), Emission{fromPhotometric(1000), false, {}});
  addPolygon(scene, lamp, {{1.5, 1.5, 2.9999}, {1.5, 2.5, 2.9999}, {2.5, 2.5, 2.9999}, {2.5, 1.5, 2.9999}});
  const double wall[] = {32.68, 75.19, 81.32, 69.06, 53.40, 40.00}, floor[] = {61.42, 79.26, 95.67, 105.78};
  std::vector<ProbePoint> points;
  for (int i = 0; i < 6; ++i) points.push_back({{2, 0, 2.75 - 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 4; ++i) points.push_back({{2, 0.25 + 0.5 * i, 0}, {0, 0, 1}});
  const auto results = measure(solved(std::move(scene)), points);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(lux(results[i]) / wall[i], 1, kTolerance) << "wall " << i;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(lux(results[6 + i]) / floor[i], 1, kTolerance) << "floor " << i;
}

// The floor is lit evenly by a sun behind the wall y = 0: what else arrives came from the floor.
TEST(SolvedCie171, Case56DiffuseReflection) {
  const SunLight sun{glm::normalize(Vec3(0, -1, 2)), 0.004654793, Rgb(1e5f)};
  const double fromFloor = 0.3 * 1e5 * solidAngle(sun) * sun.direction.z;
  const double wall[] = {.35901, .27992, .21639, .16716, .12967}, ceiling[] = {.26795, .30939, .33976, .35567};
  Scene scene;
  addPolygon(scene, addMaterial(scene, "floor", lambert(0.3f)), {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  addLight(scene, sun);
  std::vector<ProbePoint> inTheAir, onTheFarWall;
  for (int i = 0; i < 5; ++i) {
    inTheAir.push_back({{2, 0, 0.75 + 0.5 * i}, {0, 1, 0}});
    onTheFarWall.push_back({{2, 4, 0.75 + 0.5 * i}, {0, -1, 0}});
  }
  for (int i = 0; i < 4; ++i) inTheAir.push_back({{2, 0.25 + 0.5 * i, 3}, {0, 0, -1}});
  const auto gathered = measure(solved(scene), inTheAir);
  for (int i = 0; i < 9; ++i)
    EXPECT_NEAR(gathered[i].irradiance.r / fromFloor / (i < 5 ? wall[i] : ceiling[i - 5]), 1, kTolerance) << i;
  // A black far wall, which the sun lights too: the same by way of links.
  addPolygon(scene, addMaterial(scene, "black", lambert(0)), {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  const auto linked = measure(solved(scene), onTheFarWall);
  const double direct = 1e5 * solidAngle(sun) * -sun.direction.y;
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR((linked[i].irradiance.r - direct) / fromFloor / wall[i], 1, kTolerance) << "wall " << i;
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

struct Spread {
  double median, p95;
};
Spread spreadOf(std::vector<double> differences) {
  std::sort(differences.begin(), differences.end());
  return {differences[differences.size() / 2], differences[differences.size() * 95 / 100]};
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

}  // namespace
}  // namespace deltalux
