#include "direct/point_light.hpp"

#include <gtest/gtest.h>

#include "base/sobol.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// The mean over a source's unit square.
double irradiance(const direct::PointSampler& light, std::uint32_t source, const direct::Receiver& x) {
  constexpr std::uint32_t kRays = 1024;
  double sum = 0;
  for (std::uint32_t i = 0; i < kRays; ++i) {
    const UnitPair u = scrambledSobol(i, 5);
    if (const auto a = light.arrival(source, x, {u.x, u.y})) sum += glm::dot(a->direction, x.normal) * gray(a->E);
  }
  return sum / kRays;
}

double irradiance(const direct::PointSampler& light, const direct::Receiver& x) {
  double sum = 0;
  for (const direct::Source& s : light.sources(x)) sum += irradiance(light, s.id, x);
  return sum;
}

/// One small black triangle far below, so that there is something to trace.
Scene nothing() {
  Scene scene;
  addPolygon(scene, addMaterial(scene, "black", lambert(0)), {{0, 0, -50}, {0.1, 0, -50}, {0, 0.1, -50}});
  return scene;
}

TEST(PointSampler, SkiesAddUpOverTheirCells) {
  Scene scene = nothing();
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  const auto tracer = tracing::makeBruteForceTracer(scene);
  const direct::PointSampler light(scene, *tracer);
  EXPECT_NEAR(irradiance(light, {{0, 0, 0}, {0, 0, 1}}), 3 * kPi, 0.01 * kPi);
  EXPECT_NEAR(irradiance(light, {{0, 0, 0}, {1, 0, 0}}), 1.5 * kPi, 0.01 * kPi);
  EXPECT_TRUE(light.sources({{0, 0, 0}, {0, 0, -1}}).empty());
}

TEST(PointSampler, PotentialsAreOfTheSizeOfWhatArrives) {
  Scene scene = nothing();
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  const auto tracer = tracing::makeBruteForceTracer(scene);
  const direct::PointSampler light(scene, *tracer);
  const direct::Receiver x{{0, 0, 0}, glm::normalize(Vec3(1, 2, 3))};
  for (const direct::Source& s : light.sources(x)) EXPECT_GE(1.001 * double(s.potential), irradiance(light, s.id, x));
}

TEST(PointSampler, SkiesNoWiderThanACellCountAsLamps) {
  // Half a degree: no cell's grid of directions would meet it.
  const double angle = 0.5 * kPi / 180, solid = 2 * kPi * (1 - std::cos(angle));
  Scene scene = nothing();
  const Vec3 axis = glm::normalize(Vec3(0.3, 0.1, 1));
  addLight(scene, DomeLight{axis, angle, Rgb(100.0f), UniformSky{1.0}, {0, 0, 1}});
  const auto tracer = tracing::makeBruteForceTracer(scene);
  const direct::PointSampler light(scene, *tracer);
  const direct::Receiver x{{0, 0, 0}, {0, 0, 1}};
  ASSERT_EQ(light.sources(x).size(), 1u);
  EXPECT_NEAR(light.sources(x)[0].potential, 100 * solid * axis.z, 5 * solid);
  EXPECT_NEAR(irradiance(light, x), 100 * solid * axis.z, solid);
}

TEST(PointSampler, LampsBehindAreLeftOut) {
  Scene scene = nothing();
  addLight(scene, PointLight{{0, 0, 2}, Rgb(4.0f)});
  const auto tracer = tracing::makeBruteForceTracer(scene);
  const direct::PointSampler light(scene, *tracer);
  EXPECT_TRUE(light.sources({{0, 0, 0}, {0, 0, -1}}).empty());
  EXPECT_NEAR(irradiance(light, {{0, 0, 0}, {0, 0, 1}}), 1.0, 1e-6);
}

}  // namespace
}  // namespace deltalux
