// Lights whose emission depends on direction, through the solver and the reference integrator, against closed forms.
#include <gtest/gtest.h>

#include <deltalux/reference.hpp>
#include <map>

#include "io/radiance/memory_files.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

const std::string kFloor =
    "void plastic black 0 0 5 0 0 0 0 0\nblack polygon floor 0 0 12 -5 -5 0  5 -5 0  5 5 0  -5 5 0\n";

Scene read(const std::string& text, std::map<std::string, std::string> files = {}) {
  return io::radiance::test::read(text + kFloor, std::move(files)).scene;
}

/// 1000 cd down to 45 degrees from the axis, then linearly less, 2 m above the floor.
Scene downlight() {
  return read(
      "void brightdata d 4 flatcorr d.dat source.cal src_theta 0 1 12.7324\nd light l 0 0 3 1 1 1\n"
      "l ring lamp 0 0 8 0 0 2  0 0 -1  0 .158114\n",
      {{"d.dat", "1\n0 180 5\n5.5866 5.5866 0 0 0\n"}});
}

double downlightLux(double x) {
  const double theta = std::atan2(x, 2.0), I = 1000 * std::clamp(2 - theta / (kPi / 4), 0.0, 1.0);
  return I * std::pow(std::cos(theta), 3) / 4;
}

/// A large disc near the floor whose radiance falls with the cosine from its axis: E on the axis is
/// 2 pi L / 3 (1 - cos^3 of the half angle).
Scene window() {
  return read(
      "void brightfunc f 2 noneg(Dz) . 0 0  f light l 0 0 3 3 2 1\n"
      "l ring lamp 0 0 8 0 0 .5  0 0 -1  0 1\n");
}

TEST(EmissionPatterns, DownlightLightsAsItsDataSay) {
  const std::vector<double> places{0, 1, 2, 3, 4};
  std::vector<ProbePoint> points;
  for (const double x : places) points.push_back({{x, 0, 0}, {0, 0, 1}});
  const auto results = measure(solved(downlight()), points);
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_NEAR(lux(results[i]) / downlightLux(places[i]), 1, 0.02) << places[i];
}

TEST(EmissionPatterns, TheSolutionItselfHasTheirFlux) {
  // Down to 45 degrees 1000 cd fall on a disc of radius 2, and all of it on the plane: what the square floor gets lies
  // between; by quadrature of the closed form over it.
  double expected = 0;
  constexpr int kSteps = 200;
  for (int j = 0; j < kSteps; ++j)
    for (int i = 0; i < kSteps; ++i)
      expected +=
          downlightLux(std::hypot(-5 + 10 * (i + 0.5) / kSteps, -5 + 10 * (j + 0.5) / kSteps)) / (kSteps * kSteps);
  const Engine engine = solved(downlight());
  EXPECT_NEAR(kLuminousEfficacy * meshMean(engine, PrimitiveId(1)) / expected, 1, 0.02);
}

TEST(EmissionPatterns, WindowsLightAsTheirRadianceSays) {
  const double cosine = 0.5 / std::sqrt(1.25), E = 2 * kPi / 3 * (1 - std::pow(cosine, 3));
  const auto result = measure(solved(window()), {{{0, 0, 0}, {0, 0, 1}}})[0];
  EXPECT_NEAR(result.irradiance.r / (3 * E), 1, 0.01);
  EXPECT_NEAR(result.irradiance.b / E, 1, 0.01);
}

TEST(EmissionPatterns, TheReferenceIntegratorAgrees) {
  ReferenceSettings settings;
  settings.samples = 1 << 14;
  const Scene lamp = downlight(), disc = window();
  const std::vector<ProbePoint> below{{{0, 0, 0}, {0, 0, 1}}, {{3, 0, 0}, {0, 0, 1}}}, centre{{{0, 0, 0}, {0, 0, 1}}};
  const auto results = ReferenceIntegrator(lamp, settings).probe(below);
  EXPECT_NEAR(lux(results[0]) / downlightLux(0), 1, 0.01);
  EXPECT_NEAR(lux(results[1]) / downlightLux(3), 1, 0.01);
  const double cosine = 0.5 / std::sqrt(1.25), E = 2 * kPi / 3 * (1 - std::pow(cosine, 3));
  EXPECT_NEAR(ReferenceIntegrator(disc, settings).probe(centre)[0].irradiance.r / (3 * E), 1, 0.02);
}

}  // namespace
}  // namespace deltalux
