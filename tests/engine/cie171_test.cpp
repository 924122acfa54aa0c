// Cases of CIE 171 through the solver, at a target error of one per cent. [CIE 171]
#include <gtest/gtest.h>

#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr double kTolerance = 0.01;

Scene blackRoom(double height = 3) {
  Scene scene;
  addBox(scene, addMaterial(scene, "black", lambert(0)), Vec3(0), {4, 4, height}, true);
  return scene;
}

TEST(SolvedCie171, Case52PointSource) {
  Scene scene = blackRoom();
  addLight(scene, LambertPointLight{{2, 2, 3}, {0, 0, -1}, fromPhotometric(1000)});
  const std::vector<std::pair<Vec2, double>> cases = {
      {Vec2(0, 0), 111.11},  {Vec2(.5, 0), 105.21},  {Vec2(1, 0), 90.02},    {Vec2(1.5, 0), 71.11},
      {Vec2(.5, .5), 99.73}, {Vec2(1, .5), 85.64},   {Vec2(1.5, .5), 68.06}, {Vec2(1, 1), 74.36},
      {Vec2(1.5, 1), 59.98}, {Vec2(1.5, 1.5), 49.39}};
  std::vector<ProbePoint> points;
  for (const auto& [offset, expected] : cases) points.push_back({{2 + offset.x, 2 + offset.y, 0}, {0, 0, 1}});
  const auto results = measure(solved(std::move(scene)), points);
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_NEAR(lux(results[i]) / cases[i].second, 1, kTolerance) << i;
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

TEST(SolvedCie171, Case54FluxOfAPointInABlackRoom) {
  Scene scene = blackRoom();
  addLight(scene, PointLight{{2, 2, 1.5}, fromPhotometric(10000 / (4 * kPi))});
  const Engine engine = solved(scene);
  double flux = 0;
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    flux += kLuminousEfficacy * meshMean(engine, PrimitiveId(i)) * area(scene.primitives[i].shape);
  EXPECT_NEAR(flux / 10000, 1, kTolerance);
}

TEST(SolvedCie171, Case55GlassPane) {
  const double degrees[] = {0, 30, 50, 60, 70}, expected[] = {.9183, .9160, .8912, .8435, .7247};
  for (int i = 0; i < 5; ++i) {
    const double t = degrees[i] * kPi / 180;
    const auto throughPane = [&](bool pane, bool mesh) {
      Scene scene;
      addPolygon(scene, addMaterial(scene, "floor", lambert(0.5f)),
                 {{-.1, -.1, 0}, {.1, -.1, 0}, {.1, .1, 0}, {-.1, .1, 0}});
      addLight(scene, PointLight{10.0 * Vec3(std::sin(t), 0, std::cos(t)), Rgb(100.0f)});
      const MaterialId glass = addMaterial(scene, "glass", ThinGlass{});
      if (pane) addPolygon(scene, glass, {{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}});
      const Engine engine = solved(std::move(scene));
      return mesh ? meshMean(engine, PrimitiveId(0)) : measure(engine, {{Vec3(0), {0, 0, 1}}})[0].irradiance.g;
    };
    for (const bool mesh : {false, true})
      EXPECT_NEAR(throughPane(true, mesh) / throughPane(false, mesh) / expected[i], 1, kTolerance)
          << degrees[i] << (mesh ? " by the mesh" : " at the point");
  }
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
  // A black far wall, which the sun lights too: the same by the mesh.
  addPolygon(scene, addMaterial(scene, "black", lambert(0)), {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  const auto linked = measure(solved(scene), onTheFarWall);
  const double direct = 1e5 * solidAngle(sun) * -sun.direction.y;
  for (int i = 0; i < 5; ++i)
    EXPECT_NEAR((linked[i].irradiance.r - direct) / fromFloor / wall[i], 1, kTolerance) << "wall " << i;
}

TEST(SolvedCie171, Case58Interreflection) {
  const double rho[] = {.05, .2, .4, .5, .7, .9}, expected[] = {5.48, 26.0, 69.4, 104, 243, 937};
  for (int i = 0; i < 6; ++i) {
    Scene scene;
    addBox(scene, addMaterial(scene, "wall", lambert(static_cast<float>(rho[i]))), Vec3(0), Vec3(4), true);
    addLight(scene, PointLight{Vec3(2), fromPhotometric(10000 / (4 * kPi))});
    std::vector<ProbePoint> points;
    constexpr int n = 16;
    double direct = 0;
    for (int k = 0; k < n * n; ++k) {
      points.push_back({{4 * (k % n + 0.5) / n, 4 * (k / n + 0.5) / n, 0}, {0, 0, 1}});
      const Vec3 to = Vec3(2) - points.back().position;
      direct += 10000 / (4 * kPi) * to.z / std::pow(glm::length(to), 3) / (n * n);
    }
    const Engine engine = solved(std::move(scene));
    double sum = 0, mesh = 0;
    for (const ProbeResult& r : measure(engine, points)) sum += lux(r) / (n * n);
    for (std::size_t w = 0; w < 6; ++w) mesh += kLuminousEfficacy * meshMean(engine, PrimitiveId(w)) / 6;
    EXPECT_NEAR((sum - direct) / expected[i], 1, kTolerance) << "probes, rho " << rho[i];
    EXPECT_NEAR((mesh - 10000.0 / 96) / expected[i], 1, kTolerance) << "mesh, rho " << rho[i];
  }
}

}  // namespace
}  // namespace deltalux
