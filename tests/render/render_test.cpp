#include <gtest/gtest.h>

#include <deltalux/engine.hpp>
#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>
#include <deltalux/render.hpp>

#include "base/parallel.hpp"
#include "solution/solution.hpp"

namespace deltalux {
namespace {

/// A room of 2 x 2 x 2 with a window in its ceiling, under a sky and a sun, with a lamp and a small table.
Scene room() {
  Scene scene;
  scene.materials.push_back({"grey", Opaque{Rgb(0.5f, 0.4f, 0.3f), {}, {}}, std::nullopt});
  scene.materials.push_back({"lamp", Opaque{}, Emission{Rgb(5.0f), false, std::nullopt}});
  scene.materials.push_back({"pane", ThinGlass{}, std::nullopt});
  const auto add = [&](std::vector<Vec3> v, int material = 0) {
    scene.primitives.push_back({*makePolygon(std::move(v)), MaterialId(material), ObjectId()});
  };
  add({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
  add({{0, 0, 0}, {0, 0, 2}, {2, 0, 2}, {2, 0, 0}});
  add({{0, 2, 0}, {2, 2, 0}, {2, 2, 2}, {0, 2, 2}});
  add({{0, 0, 0}, {0, 2, 0}, {0, 2, 2}, {0, 0, 2}});
  add({{2, 0, 0}, {2, 0, 2}, {2, 2, 2}, {2, 2, 0}});
  add({{0, 0, 2},
       {0, 2, 2},
       {2, 2, 2},
       {2, 0, 2},
       {0, 0, 2},
       {0.5, 0.5, 2},
       {1.2, 0.5, 2},
       {1.2, 1.2, 2},
       {0.5, 1.2, 2},
       {0.5, 0.5, 2}});
  add({{0.5, 0.5, 2}, {0.5, 1.2, 2}, {1.2, 1.2, 2}, {1.2, 0.5, 2}}, 2);
  add({{1.2, 1.2, 0.7}, {1.8, 1.2, 0.7}, {1.8, 1.8, 0.7}, {1.2, 1.8, 0.7}});
  scene.primitives.push_back({Sphere{{1.6, 0.4, 1.5}, 0.1}, MaterialId(1), ObjectId()});
  scene.lights.push_back(
      {"sky", DomeLight{{0, 0, 1}, kPi / 2, Rgb(1.0f, 1.2f, 1.5f), UniformSky{0.6}, {0, 0, 1}}, Rgb(1.0f)});
  scene.lights.push_back({"sun", SunLight{glm::normalize(Vec3(0.2, 0.3, 1)), 0.02, Rgb(300.0f)}, Rgb(1.0f)});
  addAreaLights(scene);
  return scene;
}

std::vector<ProbePoint> points() {
  return {{{0.4, 0.5, 0}, {0, 0, 1}},    {{1.0, 1.0, 0}, {0, 0, 1}},     {{1.5, 1.5, 0.7}, {0, 0, 1}},
          {{1.5, 1.5, 0.7}, {0, 0, -1}}, {{0.02, 1.0, 0.02}, {0, 0, 1}}, {{0, 1, 1}, {1, 0, 0}},
          {{1.9, 1.9, 2}, {0, 0, -1}},   {{1.7, 0, 1.2}, {0, 1, 0}},     {{1.0, 1.0, 1.0}, {0, 0, 1}},
          {{0.6, 1.4, 0.5}, {1, 0, 0}},  {{1.0, 0.3, 0.9}, {0, 0, -1}}};
}

class SolvedRoom : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    engine_ = std::make_unique<Engine>(room(), SolveSettings{.error = 0.03});
    engine_->solve();
  }
  static void TearDownTestSuite() { engine_.reset(); }
  static std::unique_ptr<Engine> engine_;
};
std::unique_ptr<Engine> SolvedRoom::engine_;

TEST(Probe, MeasuresDirectLightAsTheReferenceDoes) {
  // Black walls: all light is direct, whatever the mesh.
  Scene black = room();
  black.materials[0].surface = Opaque{};
  Engine engine(black, {.error = 0.3});
  engine.solve();
  const auto where = points();
  const auto measured = probe(engine.solution(), where, {.maxSamples = 1 << 16});
  ReferenceSettings settings;
  settings.diffuseOnly = true;  // of panes, the reflection
  settings.samples = 40000;
  const auto truth = ReferenceIntegrator(black, settings).probe(where);
  for (std::size_t i = 0; i < where.size(); ++i) {
    const double se = std::hypot(gray(measured[i].standardError), gray(truth[i].standardError));
    EXPECT_NEAR(gray(measured[i].irradiance), gray(truth[i].irradiance), 5 * se + 1e-6) << i;
    EXPECT_LE(gray(measured[i].standardError), 0.03 * gray(measured[i].irradiance)) << i;
  }
}

TEST_F(SolvedRoom, ProbesAgreeWithTheReference) {
  const auto where = points();
  const auto measured = probe(engine_->solution(), where);
  ReferenceSettings settings;
  settings.diffuseOnly = true;  // of panes, the reflection
  settings.samples = 20000;
  const auto truth = ReferenceIntegrator(room(), settings).probe(where);
  double sum = 0;
  for (std::size_t i = 0; i < where.size(); ++i) {
    const double E = gray(measured[i].irradiance), T = gray(truth[i].irradiance);
    EXPECT_NEAR(E, T, 0.25 * T + 5 * gray(truth[i].standardError)) << i;
    sum += std::abs(E - T) / T;
  }
  EXPECT_LT(sum / static_cast<double>(where.size()), 0.08);
}

TEST_F(SolvedRoom, RendersTheSameForAnyNumberOfThreads) {
  View view;
  view.position = {1.0, 0.1, 1.0}, view.direction = {0, 1, -0.2}, view.horizontal = view.vertical = 80;
  RenderSettings settings;
  settings.width = settings.height = 24, settings.samplesPerPixel = 4;
  const auto draw = [&](std::size_t threads) {
    const ThreadLimit limit(threads);
    return render(engine_->solution(), view, settings).pixels;
  };
  const auto one = draw(1);
  EXPECT_EQ(one, draw(2));
  settings.seed = 2;
  EXPECT_NE(one, draw(1));
}

/// What a pane reflects and what it lets pass are not left to chance: one ray a pixel shows both.
TEST_F(SolvedRoom, AWindowShowsWhatItReflectsAndWhatIsBehindIt) {
  View view;
  view.position = {0.2, 0.85, 1.0}, view.direction = glm::normalize(Vec3(0.85, 0.85, 2) - view.position);
  view.up = {0, 1, 0}, view.horizontal = view.vertical = 10;
  RenderSettings settings;
  settings.width = settings.height = 12, settings.meshDirect = true;
  settings.samplesPerPixel = 1;
  const Image one = render(engine_->solution(), view, settings);
  settings.samplesPerPixel = 64;
  const Image many = render(engine_->solution(), view, settings);
  for (std::size_t i = 0; i < one.pixels.size(); ++i)
    EXPECT_NEAR(gray(one.pixels[i]), gray(many.pixels[i]), 0.02 * gray(many.pixels[i])) << i;
}

}  // namespace
}  // namespace deltalux
