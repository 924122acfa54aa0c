// Cases 5.2 to 5.8 [CIE 171]. Values that are written out are by quadrature or closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/cie171/cases.hpp"
#include "support/cie171/panorama.hpp"
#include "support/solved.hpp"

namespace deltalux::test::cie171 {

namespace {

constexpr double kFloorReflectance = 0.3;
constexpr double kFaint = 0.01;  // of the largest: errors of what is less are relative to that

Scene litFloor(const SunLight& sun) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "floor", lambert(float(kFloorReflectance))),
             {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  addLight(scene, sun);
  return scene;
}

/// Exitance of the lit floor [lm/m2].
double floorExitance(const SunLight& sun) {
  return kLuminousEfficacy * kFloorReflectance * double(sun.radiance.g) * solidAngle(sun) * sun.direction.z;
}

}  // namespace

std::vector<double> valuesOf(const Case& c, const std::vector<ProbeResult>& results) {
  std::vector<double> values;
  for (std::size_t i = 0; i < results.size(); ++i)
    values.push_back(lux(results[i]) - (c.known.empty() ? 0 : c.known[i]));
  if (c.expected.size() == values.size()) return values;
  double mean = 0;
  for (const double value : values) mean += value / double(values.size());
  return {mean};
}

std::vector<double> relativeErrors(const Case& c, const std::vector<ProbeResult>& results) {
  std::vector<double> errors = valuesOf(c, results);
  const double faint = kFaint * *std::max_element(c.expected.begin(), c.expected.end());
  for (std::size_t i = 0; i < errors.size(); ++i)
    errors[i] = std::abs(errors[i] - c.expected[i]) / std::max(c.expected[i], faint);
  return errors;
}

Scene blackRoom() {
  Scene scene;
  addBox(scene, addMaterial(scene, "black", lambert(0)), Vec3(0), {4, 4, 3}, true);
  return scene;
}

Case pointSource() {
  Case c{"5.2", "", blackRoom(), {}, {}};
  addLight(c.scene, LambertPointLight{{2, 2, 3}, {0, 0, -1}, fromPhotometric(1000)});
  const std::vector<std::pair<Vec2, double>> offsets = {
      {Vec2(0, 0), 111.11},  {Vec2(.5, 0), 105.21},  {Vec2(1, 0), 90.02},    {Vec2(1.5, 0), 71.11},
      {Vec2(.5, .5), 99.73}, {Vec2(1, .5), 85.64},   {Vec2(1.5, .5), 68.06}, {Vec2(1, 1), 74.36},
      {Vec2(1.5, 1), 59.98}, {Vec2(1.5, 1.5), 49.39}};
  for (const auto& [offset, expected] : offsets) {
    c.points.push_back({{2 + offset.x, 2 + offset.y, 0}, {0, 0, 1}});
    c.expected.push_back(expected);
  }
  return c;
}

Case areaSource() {
  Case c{"5.3", "", blackRoom(), {}, {32.68, 75.19, 81.32, 69.06, 53.40, 40.00, 61.42, 79.26, 95.67, 105.78}};
  const MaterialId lamp = addMaterial(c.scene, "lamp", lambert(0), Emission{fromPhotometric(1000), false, {}});
  addPolygon(c.scene, lamp, {{1.5, 1.5, 2.9999}, {1.5, 2.5, 2.9999}, {2.5, 2.5, 2.9999}, {2.5, 1.5, 2.9999}});
  for (int i = 0; i < 6; ++i) c.points.push_back({{2, 0, 2.75 - 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 4; ++i) c.points.push_back({{2, 0.25 + 0.5 * i, 0}, {0, 0, 1}});
  return c;
}

Case fluxInABlackRoom() {
  constexpr double kFlux = 10000, kCell = 0.25;
  const Vec3 size(4, 4, 3), lamp(2, 2, 1.5);
  Case c{"5.4", "", blackRoom(), {}, {}};
  addLight(c.scene, PointLight{lamp, fromPhotometric(kFlux / (4 * kPi))});
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side) {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (double u = kCell / 2; u < size[a]; u += kCell)
        for (double v = kCell / 2; v < size[b]; v += kCell) {
          ProbePoint p{Vec3(0), Vec3(0)};
          p.position[axis] = side * size[axis], p.position[a] = u, p.position[b] = v;
          p.normal[axis] = side ? -1 : 1;
          const Vec3 to = lamp - p.position;
          c.points.push_back(p);
          c.expected.push_back(kFlux / (4 * kPi) * glm::dot(to, p.normal) / std::pow(glm::length(to), 3));
        }
    }
  return c;
}

Case glassPane(int angle) {
  constexpr double expected[] = {.9183, .9160, .8912, .8435, .7247};
  constexpr double kDistance = 10, kIntensity = 1e4;
  const double t = kPaneDegrees[angle] * kPi / 180;
  Case c{"5.5", std::to_string(int(kPaneDegrees[angle])) + " degrees", {}, {{Vec3(0), {0, 0, 1}}}, {}};
  c.expected.push_back(expected[angle] * kIntensity / (kDistance * kDistance) * std::cos(t));
  addPolygon(c.scene, addMaterial(c.scene, "floor", lambert(0.5f)),
             {{-.1, -.1, 0}, {.1, -.1, 0}, {.1, .1, 0}, {-.1, .1, 0}});
  addPolygon(c.scene, addMaterial(c.scene, "glass", ThinGlass{}), {{-9, -9, 2}, {9, -9, 2}, {9, 9, 2}, {-9, 9, 2}});
  addLight(c.scene, PointLight{kDistance * Vec3(std::sin(t), 0, std::cos(t)), fromPhotometric(kIntensity)});
  return c;
}

// The floor is lit evenly by a sun behind the wall y = 0: what else arrives came from the floor.
Case diffuseReflection(bool onAWall) {
  const SunLight sun{glm::normalize(Vec3(0, -1, 2)), 0.004654793, Rgb(1e5f)};
  constexpr double wall[] = {.35901, .27992, .21639, .16716, .12967}, ceiling[] = {.26795, .30939, .33976, .35567};
  Case c{"5.6", onAWall ? "on a wall" : "in the air", litFloor(sun), {}, {}};
  const double direct = kLuminousEfficacy * 1e5 * solidAngle(sun) * -sun.direction.y;
  for (int i = 0; i < 5; ++i) {
    if (onAWall) c.points.push_back({{2, 4, 0.75 + 0.5 * i}, {0, -1, 0}}), c.known.push_back(direct);
    if (!onAWall) c.points.push_back({{2, 0, 0.75 + 0.5 * i}, {0, 1, 0}});
    c.expected.push_back(wall[i] * floorExitance(sun));
  }
  if (onAWall)
    addPolygon(c.scene, addMaterial(c.scene, "black", lambert(0)), {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  for (int i = 0; i < 4 && !onAWall; ++i) {
    c.points.push_back({{2, 0.25 + 0.5 * i, 3}, {0, 0, -1}});
    c.expected.push_back(ceiling[i] * floorExitance(sun));
  }
  return c;
}

// The same below a sun so high that a black screen across the floor, 1 m high, shades 0.2 mm of it. The screen hides
// the floor's far part from the wall y = 0, and some of it from the ceiling.
Case reflectionPastAScreen() {
  const SunLight sun{glm::normalize(Vec3(0, -2e-4, 1)), 1e-4, Rgb(1e8f)};
  const Facet wall{1, 0, {0, 0}, {4, 3}}, screen{1, 2, {0, 0}, {4, 1}};
  Facet floor{2, 0, {0, 0}, {4, 4}};
  floor.luminance = floorExitance(sun) / kPi;
  Case c{"5.7", "", litFloor(sun), {}, {}};
  addFacets(c.scene, {wall, screen});
  for (int i = 0; i < 6; ++i) c.points.push_back({{2, 0, 0.25 + 0.5 * i}, {0, 1, 0}});
  for (int i = 0; i < 8; ++i) c.points.push_back({{2, 0.25 + 0.5 * i, 3}, {0, 0, -1}});
  const Panorama panorama(
      {wall, screen, floor}, [](const Vec3&) { return 0.0; }, sun.direction, 12);
  for (const ProbePoint& p : c.points) c.expected.push_back(panorama.illuminance(p.position, p.normal));
  return c;
}

// Area means over one face of a closed cube, which by symmetry stands for all: E = rho Phi / ((1 - rho) A).
Case interreflection(int reflectance) {
  constexpr int n = 16;
  constexpr double kFlux = 10000, kArea = 96;
  const double rho = kWallReflectances[reflectance];
  Case c{"5.8", fmt::format("rho {}", rho), {}, {}, {rho * kFlux / ((1 - rho) * kArea)}};
  addBox(c.scene, addMaterial(c.scene, "wall", lambert(static_cast<float>(rho))), Vec3(0), Vec3(4), true);
  addLight(c.scene, PointLight{Vec3(2), fromPhotometric(kFlux / (4 * kPi))});
  for (int k = 0; k < n * n; ++k) {
    c.points.push_back({{4 * (k % n + 0.5) / n, 4 * (k / n + 0.5) / n, 0}, {0, 0, 1}});
    const Vec3 to = Vec3(2) - c.points.back().position;
    c.known.push_back(kFlux / (4 * kPi) * to.z / std::pow(glm::length(to), 3));
  }
  return c;
}

std::vector<Case> electricCases() {
  std::vector<Case> cases;
  cases.push_back(pointSource()), cases.push_back(areaSource()), cases.push_back(fluxInABlackRoom());
  for (int i = 0; i < 5; ++i) cases.push_back(glassPane(i));
  cases.push_back(diffuseReflection(false)), cases.push_back(diffuseReflection(true));
  cases.push_back(reflectionPastAScreen());
  for (int i = 0; i < 6; ++i) cases.push_back(interreflection(i));
  return cases;
}

}  // namespace deltalux::test::cie171
