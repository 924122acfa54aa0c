#include "direct/lamp_meter.hpp"

#include <gtest/gtest.h>

#include "scene/nominal_scale.hpp"
#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

/// Irradiance of an upward facing point.
struct Above {
  explicit Above(Scene s)
      : scene(std::move(s)),
        tracer(tracing::makeBruteForceTracer(scene)),
        meter(scene, *tracer, scene::scalesOf(scene)) {}
  double at(const Vec3& p, double error = 0.01) const { return gray(meter.read(p, {0, 0, 1}, 0, error).E); }

  Scene scene;
  std::shared_ptr<const tracing::RayTracer> tracer;
  direct::LampMeter meter;
};

/// A square metre of a lamp 2 m up, that looks down; a screen 1 m up covers all of x < 0.
Scene lampOverScreen(bool screen) {
  Scene scene;
  const MaterialId black = addMaterial(scene, "black", lambert(0));
  const MaterialId lamp = addMaterial(scene, "lamp", lambert(0), Emission{Rgb(3.0f), false, {}, {}});
  addPolygon(scene, lamp, {{-0.5, -0.5, 2}, {-0.5, 0.5, 2}, {0.5, 0.5, 2}, {0.5, -0.5, 2}});
  addPolygon(scene, black,
             screen ? std::vector<Vec3>{{-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}}
                    : std::vector<Vec3>{{0, 0, -50}, {0.1, 0, -50}, {0, 0.1, -50}});
  addAreaLights(scene);
  return scene;
}

TEST(LampMeter, AnOpenLampIsItsClosedForm) {
  const Above above(lampOverScreen(false));
  // Of a square of half size a at height h over its middle: 4 / (2 pi) * 2 a / sqrt(h^2 + a^2) atan(a / sqrt(h^2 +
  // a^2)).
  const double a = 0.5, r = std::sqrt(4 + a * a), F = 4 / kPi * a / r * std::atan(a / r);
  EXPECT_NEAR(above.at({0, 0, 0}), 3 * kPi * F, 1e-5);
}

TEST(LampMeter, APenumbraIsTheShareThatIsSeen) {
  const Scene open = lampOverScreen(false), covered = lampOverScreen(true);
  const Above above(open), below(covered);
  // The screen's edge is half way up: from x the lamp is seen where it lies beyond -x.
  EXPECT_EQ(below.at({-0.6, 0, 0}), 0);
  EXPECT_NEAR(below.at({0.6, 0, 0}), above.at({0.6, 0, 0}), 1e-6);
  EXPECT_NEAR(below.at({0, 0, 0}), 0.5 * above.at({0, 0, 0}), 0.01 * above.at({0, 0, 0}));
  double before = 0;
  for (double x = -0.5; x <= 0.5; x += 0.05) {
    const double share = below.at({x, 0, 0}) / above.at({x, 0, 0});
    EXPECT_NEAR(share, x + 0.5, 0.06) << x;
    EXPECT_GE(share, before - 0.01) << x;
    before = share;
  }
}

TEST(LampMeter, TheSunIsItsDisc) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "black", lambert(0)), {{-9, -9, 1}, {0, -9, 1}, {0, 9, 1}, {-9, 9, 1}});
  SunLight sun;
  sun.direction = glm::normalize(Vec3(0, 0.5, 1)), sun.radiance = Rgb(1e4f);
  addLight(scene, sun);
  const Above above(scene);
  const double E = 1e4 * solidAngle(sun) * sun.direction.z;
  EXPECT_NEAR(above.at({1, 0, 0}), E, 1e-3 * E);
  EXPECT_NEAR(above.at({0, 0, 0}), 0.5 * E, 0.02 * E);
  EXPECT_EQ(above.at({-1, 0, 0}), 0);
}

TEST(LampMeter, PointsShineAtOnce) {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "black", lambert(0)), {{0, 0, -50}, {0.1, 0, -50}, {0, 0.1, -50}});
  addLight(scene, PointLight{{0, 0, 2}, Rgb(4.0f)});
  EXPECT_NEAR(Above(scene).at({0, 0, 0}), 1, 1e-6);
}

TEST(LampMeter, ScalesCount) {
  const Scene scene = lampOverScreen(false);
  const auto tracer = tracing::makeBruteForceTracer(scene);
  const direct::LampMeter dimmed(scene, *tracer, {Rgb(0.25f)}), off(scene, *tracer, {Rgb(0.0f)});
  EXPECT_NEAR(gray(dimmed.read({0, 0, 0}, {0, 0, 1}, 0, 0.01).E), 0.25 * Above(scene).at({0, 0, 0}), 1e-5);
  EXPECT_TRUE(off.dark());
}

}  // namespace
}  // namespace deltalux
