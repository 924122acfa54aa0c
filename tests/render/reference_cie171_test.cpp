// CIE 171:2006 analytical cases, expected values recomputed by quadrature.
#include <gtest/gtest.h>

#include <deltalux/reference.hpp>

#include "base/sobol.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

constexpr double kTolerance = 0.005;

double lux(const ProbeResult& r) { return photometric(r.irradiance, kLuminousEfficacy); }
Rgb fromPhotometric(double value) { return Rgb(static_cast<float>(value / kLuminousEfficacy)); }

std::vector<ProbeResult> measure(const Scene& scene, const std::vector<ProbePoint>& points, std::uint64_t samples) {
  ReferenceSettings settings;
  settings.samples = samples;
  return ReferenceIntegrator(scene, settings).probe(points);
}

Scene blackRoom(double height = 3) {
  Scene scene;
  addBox(scene, addMaterial(scene, "black", lambert(0)), Vec3(0), {4, 4, height}, true);
  return scene;
}

TEST(Cie171, Case52PointSource) {
  Scene scene = blackRoom();
  addLight(scene, LambertPointLight{{2, 2, 3}, {0, 0, -1}, fromPhotometric(1000)});
  const std::vector<std::pair<Vec2, double>> cases = {
      {Vec2(0, 0), 111.11},  {Vec2(.5, 0), 105.21},  {Vec2(1, 0), 90.02},    {Vec2(1.5, 0), 71.11},
      {Vec2(.5, .5), 99.73}, {Vec2(1, .5), 85.64},   {Vec2(1.5, .5), 68.06}, {Vec2(1, 1), 74.36},
      {Vec2(1.5, 1), 59.98}, {Vec2(1.5, 1.5), 49.39}};
  std::vector<ProbePoint> points;
  for (const auto& [offset, expected] : cases) points.push_back({{2 + offset.x, 2 + offset.y, 0}, {0, 0, 1}});
  const auto results = measure(scene, points, 16);
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_NEAR(lux(results[i]) / cases[i].second, 1.0, kTolerance);
}

TEST(Cie171, Case53AreaSource) {
  Scene scene = blackRoom();
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0), Emission{fromPhotometric(1000), false, {}});
  addPolygon(scene, lamp, {{1.5, 1.5, 2.9999}, {1.5, 2.5, 2.9999}, {2.5, 2.5, 2.9999}, {2.5, 1.5, 2.9999}});
  const double wall[] = {32.68, 75.19, 81.32, 69.06, 53.40, 40.00}, floor[] = {61.42, 79.26, 95.67, 105.78};
  std::vector<ProbePoint> points;
  for (int i = 0; i < 6; ++i) points.push_back({{2, 0, 2.75 - 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 4; ++i) points.push_back({{2, 0.25 + 0.5 * i, 0}, {0, 0, 1}});
  const auto results = measure(scene, points, 4096);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(lux(results[i]) / wall[i], 1.0, kTolerance) << "wall " << i;
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(lux(results[6 + i]) / floor[i], 1.0, kTolerance) << "floor " << i;
}

/// Midpoints of an n x n grid on each of the six faces of a box, with their share of the area.
struct FacePoint {
  ProbePoint probe;
  double area;
};
std::vector<FacePoint> facePoints(const Vec3& size, int n) {
  std::vector<FacePoint> points;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      for (int k = 0; k < n * n; ++k) {
        ProbePoint p{Vec3(0), Vec3(0)};
        p.position[axis] = side * size[axis];
        p.position[a] = size[a] * (k % n + 0.5) / n, p.position[b] = size[b] * (k / n + 0.5) / n;
        p.normal[axis] = side ? -1 : 1;
        points.push_back({p, size[a] * size[b] / (n * n)});
      }
    }
  }
  return points;
}

TEST(Cie171, Case54FluxOfAPointInABlackRoom) {
  Scene scene = blackRoom();
  addLight(scene, PointLight{{2, 2, 1.5}, fromPhotometric(10000 / (4 * kPi))});
  double flux = 0;
  const auto points = facePoints({4, 4, 3}, 24);
  std::vector<ProbePoint> probes;
  for (const auto& p : points) probes.push_back(p.probe);
  const auto results = measure(scene, probes, 1);
  for (std::size_t i = 0; i < points.size(); ++i) flux += lux(results[i]) * points[i].area;
  EXPECT_NEAR(flux / 10000, 1.0, kTolerance);
}

TEST(Cie171, Case55GlassPane) {
  const double degrees[] = {0, 30, 50, 60, 70}, expected[] = {.9183, .9160, .8912, .8435, .7247};
  for (int i = 0; i < 5; ++i) {
    const double t = degrees[i] * kPi / 180;
    const auto measureThrough = [&](bool pane) {
      Scene scene;
      addBox(scene, addMaterial(scene, "black", lambert(0)), Vec3(-100), Vec3(100), true);
      addLight(scene, PointLight{10.0 * Vec3(std::sin(t), 0, std::cos(t)), Rgb(100.0f)});
      const MaterialId glass = addMaterial(scene, "glass", ThinGlass{});
      if (pane) addPolygon(scene, glass, {{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}});
      return measure(scene, {{Vec3(0), {0, 0, 1}}}, 4096)[0].irradiance.g;
    };
    EXPECT_NEAR(measureThrough(true) / measureThrough(false) / expected[i], 1.0, kTolerance) << degrees[i];
  }
}

// The floor is lit evenly and nothing else is there: what arrives on walls and ceiling came from the floor.
TEST(Cie171, Case56DiffuseReflection) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "floor", lambert(0.3f)), {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  const SunLight sun{glm::normalize(Vec3(0, -1, 2)), 0.004654793, Rgb(1e5f)};  // behind the wall y = 0
  addLight(scene, sun);
  const double horizontal = 1e5 * solidAngle(sun) * sun.direction.z;
  const double wall[] = {35.901, 27.992, 21.639, 16.716, 12.967}, ceiling[] = {26.795, 30.939, 33.976, 35.567};
  std::vector<ProbePoint> points;
  for (int i = 0; i < 5; ++i) points.push_back({{2, 0, 0.75 + 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 4; ++i) points.push_back({{2, 0.25 + 0.5 * i, 3}, {0, 0, -1}});
  const auto results = measure(scene, points, 65536);
  for (int i = 0; i < 9; ++i) {
    const double expected = (i < 5 ? wall[i] : ceiling[i - 5]) / 100;
    EXPECT_NEAR(results[i].irradiance.r / (0.3 * horizontal) / expected, 1.0, kTolerance) << i;
  }
}

// Area means over one face, which by symmetry stands for all, at stratified points.
TEST(Cie171, Case58Interreflection) {
  const double rho[] = {.05, .2, .4, .5, .7, .9}, expected[] = {5.48, 26.0, 69.4, 104, 243, 937};
  const std::uint64_t samples[] = {128, 128, 128, 128, 256, 512};
  std::vector<ProbePoint> probes;
  for (std::uint32_t i = 0; i < 1024; ++i) {
    const UnitPair u = scrambledSobol(i, 58);
    probes.push_back({{4 * u.x, 4 * u.y, 0}, {0, 0, 1}});
  }
  for (int i = 0; i < 6; ++i) {
    const auto mean = [&](float reflectance, std::uint64_t count) {
      Scene scene;
      addBox(scene, addMaterial(scene, "wall", lambert(reflectance)), Vec3(0), Vec3(4), true);
      addLight(scene, PointLight{Vec3(2), fromPhotometric(10000 / (4 * kPi))});
      double sum = 0;
      for (const ProbeResult& r : measure(scene, probes, count)) sum += lux(r);
      return sum / static_cast<double>(probes.size());
    };
    const double indirect = mean(static_cast<float>(rho[i]), samples[i]) - mean(0, 1);
    EXPECT_NEAR(indirect / expected[i], 1.0, kTolerance) << "rho " << rho[i];
  }
}

}  // namespace
}  // namespace deltalux
