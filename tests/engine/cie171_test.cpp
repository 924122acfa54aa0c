// Cases of CIE 171 through the solver: 5.2 to 5.8 at a target error of one per cent, 5.9 to 5.14 under a sky each at
// five (all sixteen, and 5.10: cie171_slow_test.cpp, which says what is left out of 5.14). [CIE 171]
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/cie171/cases.hpp"
#include "support/cie171/expect_daylight.hpp"
#include "support/cie171/panorama.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;
using namespace test::cie171;

constexpr double kTolerance = 0.01;

void expectAtPoints(const Case& c, const Engine& engine, double tolerance) {
  const std::vector<double> values = valuesOf(c, measure(engine, c.points));
  ASSERT_EQ(values.size(), c.expected.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_NEAR(values[i] / c.expected[i], 1, tolerance) << c.name << " " << c.variant << ", point " << i;
}

void expectAtPoints(const Case& c) { expectAtPoints(c, solved(c.scene), kTolerance); }

TEST(SolvedCie171, Case52PointSource) { expectAtPoints(pointSource()); }
TEST(SolvedCie171, Case53AreaSource) { expectAtPoints(areaSource()); }

TEST(SolvedCie171, Case54FluxOfAPointInABlackRoom) {
  const Case c = fluxInABlackRoom();
  const Engine engine = solved(c.scene);
  expectAtPoints(c, engine, kTolerance);
  double flux = 0;
  for (std::size_t i = 0; i < c.scene.primitives.size(); ++i)
    flux += kLuminousEfficacy * meshMean(engine, PrimitiveId(i)) * area(c.scene.primitives[i].shape);
  EXPECT_NEAR(flux / 10000, 1, kTolerance);
}

TEST(SolvedCie171, Case55GlassPane) {
  for (int i = 0; i < 5; ++i) {
    const Case c = glassPane(i);
    const Engine engine = solved(c.scene);
    expectAtPoints(c, engine, kTolerance);
    EXPECT_NEAR(kLuminousEfficacy * meshMean(engine, PrimitiveId(0)) / c.expected[0], 1, kTolerance)
        << c.variant << " by the mesh";
  }
}

TEST(SolvedCie171, Case56DiffuseReflection) {
  expectAtPoints(diffuseReflection(false));
  expectAtPoints(diffuseReflection(true));
}

TEST(SolvedCie171, Case57ReflectionPastAScreen) { expectAtPoints(reflectionPastAScreen()); }

TEST(SolvedCie171, Case58Interreflection) {
  for (int i = 0; i < 6; ++i) {
    const Case c = interreflection(i);
    const Engine engine = solved(c.scene);
    expectAtPoints(c, engine, kTolerance);
    double mesh = 0;
    for (std::size_t w = 0; w < 6; ++w) mesh += kLuminousEfficacy * meshMean(engine, PrimitiveId(w)) / 6;
    EXPECT_NEAR((mesh - 10000.0 / 96) / c.expected[0], 1, kTolerance) << "mesh, " << c.variant;
  }
}

// The references themselves: closed forms, and twice as fine.

TEST(Cie171Panorama, OpenGroundHasTheClosedForms) {
  const auto open = [](const test::cie171::GeneralSky& sky, const Vec3& normal) {
    return Panorama({}, sky, sky.sun).illuminance(Vec3(0), normal);
  };
  EXPECT_NEAR(open({5}, {0, 0, 1}) / kPi, 1, 1e-9);
  EXPECT_NEAR(open({5}, {0, 1, 0}) / (kPi / 2), 1, 1e-9);
  EXPECT_NEAR(open({kTraditionalOvercast}, {0, 0, 1}) / (7 * kPi / 9), 1, 1e-9);
}

// Of a rectangle parallel to the receiver, with a corner above it. [Lambert1760]
TEST(Cie171Panorama, ARectangleOverheadHasTheClosedForm) {
  const Facet ceiling{2, 1, {0, 0}, {2, 3}, 0, 1};
  const Panorama panorama({ceiling}, [](const Vec3&) { return 0.0; }, {0, 0, 1});
  const double a = 2 / std::sqrt(5.0), b = 3 / std::sqrt(10.0);
  const double expected = (a * std::atan(3 / std::sqrt(5.0)) + b * std::atan(2 / std::sqrt(10.0))) / 2;
  EXPECT_NEAR(panorama.illuminance({0, 0, 0}, {0, 0, 1}) / expected, 1, 1e-6);
}

TEST(Cie171Panorama, PanesAreTheLibrarys) {
  const ThinGlass glass{Rgb(float(kGlassTransmissivity)), float(kGlassIndex)};
  for (double cosine = 0.05; cosine <= 1; cosine += 0.05) {
    EXPECT_NEAR(paneAt(cosine).transmittance, transmittance(glass, cosine).g, 1e-6) << cosine;
    EXPECT_NEAR(paneAt(cosine).reflectance, reflectance(glass, cosine).g, 1e-6) << cosine;
  }
  EXPECT_NEAR(paneAt(1).transmittance, polynomialTransmittance(1), 1e-3);
}

TEST(Cie171Panorama, SkiesAreTheLibrarys) {
  for (int type = 1; type <= kSkies; ++type) {
    const test::cie171::GeneralSky sky{type, glm::normalize(Vec3(-1, -1, 2.4))};
    const DomeLight light = skyLight(sky, kLuminousEfficacy);
    for (int i = 0; i < 64; ++i) {
      const double z = (i + 0.5) / 64, turn = 2.4 * i;
      const Vec3 w(std::sqrt(1 - z * z) * Vec2(std::cos(turn), std::sin(turn)), z);
      EXPECT_NEAR(skyRadiance(light, w).g / sky(w), 1, 2e-4) << type << " " << z;
    }
  }
}

TEST(Cie171Panorama, HasConverged) {
  const Daylight d = findDaylight("5.13", "2x1");
  const std::vector<double> values = daylightReference(d, 12), finer = daylightReference(d, 12, 11);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], finer[i], 1e-4 * finer[i]) << i;
}

struct DaylightTest : testing::TestWithParam<std::tuple<std::string, std::string, int>> {};

TEST_P(DaylightTest, IsWithinTheErrorAskedFor) {
  const auto& [name, variant, sky] = GetParam();
  expectDaylight(findDaylight(name, variant), sky, 0.05);
}

std::string nameOf(const testing::TestParamInfo<DaylightTest::ParamType>& info) {
  const auto& [name, variant, sky] = info.param;
  std::string all = fmt::format("Case{}_{}_Sky{}", name, variant, sky);
  std::erase(all, '.');
  std::replace(all.begin(), all.end(), ' ', '_');
  return all;
}

INSTANTIATE_TEST_SUITE_P(SolvedCie171, DaylightTest,
                         testing::Values(std::tuple("5.9", "1x1", 16), std::tuple("5.9", "4x4", 12),
                                         std::tuple("5.11", "2x1", 1), std::tuple("5.11", "4x3", 12),
                                         std::tuple("5.12", "2x1", 12), std::tuple("5.12", "4x3", 16),
                                         std::tuple("5.13", "2x1", 15), std::tuple("5.13", "4x3", 1),
                                         std::tuple("5.14", "4x3", 5), std::tuple("5.14", "4x3 grey mask", 12)),
                         nameOf);

}  // namespace
}  // namespace deltalux
