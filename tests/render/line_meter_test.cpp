// Light meters over a solution by lines: on surfaces, and in the air, where light comes by way of mirrors and panes.
#include <gtest/gtest.h>

#include <deltalux/contributions.hpp>
#include <deltalux/reference.hpp>
#include <deltalux/solution_reader.hpp>

#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A diffuse room with a hole in the roof that the sun shines through, onto a mirror that leans on the floor.
Scene sunOnMirror() {
  Scene scene;
  const MaterialId grey = addMaterial(scene, "grey", lambert(0.5f));
  addPolygon(scene, grey, {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
  addPolygon(scene, grey, {{0, 0, 0}, {0, 0, 3}, {4, 0, 3}, {4, 0, 0}});
  addPolygon(scene, grey, {{0, 4, 0}, {4, 4, 0}, {4, 4, 3}, {0, 4, 3}});
  addPolygon(scene, grey, {{0, 0, 0}, {0, 4, 0}, {0, 4, 3}, {0, 0, 3}});
  addPolygon(scene, grey, {{4, 0, 0}, {4, 0, 3}, {4, 4, 3}, {4, 4, 0}});
  addPolygon(scene, grey,
             {{0, 0, 3},
              {0, 4, 3},
              {4, 4, 3},
              {4, 0, 3},
              {0, 0, 3},
              {1.5, 1.5, 3},
              {2.5, 1.5, 3},
              {2.5, 2.5, 3},
              {1.5, 2.5, 3},
              {1.5, 1.5, 3}});
  addPolygon(scene, addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
             {{1.6, 1.6, 0.1}, {2.4, 1.6, 0.9}, {2.4, 2.4, 0.9}, {1.6, 2.4, 0.1}});
  addLight(scene, SunLight{{0, 0, 1}, 0.25 * kPi / 180, Rgb(2e6f)});
  return scene;
}

class LineMeterTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    engine_ = std::make_unique<Engine>(sunOnMirror(), SolveSettings{.error = 0.03});
    engine_->solve();
  }
  static void TearDownTestSuite() { engine_.reset(); }
  static std::vector<ProbeResult> reference(const std::vector<ProbePoint>& points) {
    ReferenceSettings settings;
    settings.samples = 1 << 17;
    return ReferenceIntegrator(sunOnMirror(), settings).probe(points);
  }

  static std::unique_ptr<Engine> engine_;
};
std::unique_ptr<Engine> LineMeterTest::engine_;

TEST_F(LineMeterTest, InTheAirSeesWhatAMirrorThrows) {
  // In the beam that goes off sideways, beside it, and two centimetres above the floor towards it.
  const std::vector<ProbePoint> points = {
      {{1.0, 2.0, 0.5}, {1, 0, 0}}, {{1.0, 3.5, 0.5}, {1, 0, 0}}, {{3.2, 3.2, 0.02}, {0, 0, -1}}};
  const auto E = probe(engine_->solution(), points, {.error = 0.01, .maxSamples = 1 << 16});
  const auto truth = reference(points);
  EXPECT_GT(truth[0].irradiance.g, 3 * truth[1].irradiance.g) << "the first is in the beam";
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(E[i].irradiance.g, 0.0);
    EXPECT_NEAR(E[i].irradiance.g, truth[i].irradiance.g, 0.1 * truth[i].irradiance.g) << i;
  }
}

TEST_F(LineMeterTest, TellsHowExactItIs) {
  std::vector<ProbePoint> points;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 5; ++j) points.push_back({{0, 0.25 + 0.5 * i, 0.3 + 0.5 * j}, {1, 0, 0}});
  const auto a = probe(engine_->solution(), points, {.error = 0.02, .maxSamples = 1 << 17, .seed = 1});
  const auto b = probe(engine_->solution(), points, {.error = 0.02, .maxSamples = 1 << 17, .seed = 2});
  double squares = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_LE(gray(a[i].standardError), 0.021 * gray(a[i].irradiance));
    const double se = std::hypot(a[i].standardError.g, b[i].standardError.g);
    ASSERT_GT(se, 0.0);
    squares += std::pow((a[i].irradiance.g - b[i].irradiance.g) / se, 2);
  }
  const double rms = std::sqrt(squares / static_cast<double>(points.size()));
  EXPECT_LT(rms, 1.4);
  EXPECT_GT(rms, 0.2);
}

TEST_F(LineMeterTest, ContributionsAddUpToTheReading) {
  const SolutionReader reader(engine_->solution());
  const ProbePoint point{{0.0, 2.0, 1.5}, {1, 0, 0}};
  const Contributions c = reader.contributions(point, {});
  const ProbeResult r = reader.probe(std::vector{point}).front();
  ASSERT_TRUE(c.onSurface);
  EXPECT_FALSE(c.surfaces.empty());
  EXPECT_NEAR(gray(c.direct + c.indirect + c.particle), gray(r.irradiance), 0.08 * gray(r.irradiance));
}

}  // namespace
}  // namespace deltalux
