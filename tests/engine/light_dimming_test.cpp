// Lights that are dimmed, coloured or switched: weights of what is there.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "hierarchy/leaf_table.hpp"
#include "support/furnished_room.hpp"
#include "support/rooms.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

/// A room with a window to the sky and the sun, a table, and three lamps.
Scene roomOfManyLights() {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  const MaterialId brass = addMaterial(scene, "brass", Mirror{Rgb(0.8f, 0.7f, 0.4f)});
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  scene.primitives.erase(scene.primitives.begin());  // a wall
  addBox(scene, white, {1, 1, 0.6}, {2, 2, 0.7}, false);
  addPolygon(scene, brass, {{2.5, 1, 0.1}, {3, 1, 0.1}, {3, 2, 0.3}, {2.5, 2, 0.3}});
  const auto add = [&](auto emitter, const char* name) {
    addLight(scene, emitter);
    scene.lights.back().name = name;
  };
  add(PointLight{{2, 1.5, 2.3}, Rgb(5.0f)}, "ceiling");
  add(PointLight{{0.5, 0.5, 1.2}, Rgb(1, 0.8f, 0.5f)}, "reading");
  add(PointLight{{3.5, 2.5, 0.5}, Rgb(0.5f, 0.5f, 1)}, "night");
  SunLight sun;
  sun.direction = glm::normalize(Vec3(-1, -0.2, 0.6)), sun.radiance = Rgb(2e5f);
  add(sun, "sun");
  add(DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}}, "sky");
  return scene;
}

std::vector<Rgb> irradiance(const Engine& engine) {
  const SolutionView view = engine.solution();
  const Solution& s = view.get();
  std::vector<Rgb> all;
  for (const hierarchy::ElementId e : hierarchy::LeafTable(s.elements).leaves) {
    const hierarchy::ElementLight& l = s.elements.radiometry[e.index()];
    all.push_back(l.direct + l.indirect + l.particle);
  }
  return all;
}

/// Greatest difference of a leaf, relative to the mean of all.
double difference(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double mean = 0, most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    mean += gray(b[i]) / static_cast<double>(a.size()),
        most = std::max<double>(most, maxChannel(glm::abs(a[i] - b[i])));
  return most / mean;
}

void expectFresh(const Engine& engine, const std::string& after) {
  Engine fresh(engine.solution().scene(), engine.solution().settings());
  fresh.solve();
  EXPECT_EQ(hashOf(engine), hashOf(fresh)) << after;
  const std::vector<Rgb> a = irradiance(engine), b = irradiance(fresh);
  ASSERT_EQ(a.size(), b.size()) << after;
  EXPECT_LT(difference(a, b), 2e-3) << after;
}

TEST(LightDimming, TracesNoRayAndIsTheFreshSolve) {
  Engine engine(roomOfManyLights(), coarse());
  engine.solve();
  const std::vector<std::pair<std::string, Edit>> edits{
      {"dimmed", ScaleLight{"ceiling", 0.3f}},        {"coloured", ColourLight{"reading", Rgb(0.9f, 0.2f, 0)}},
      {"off", SwitchLight{"night", false}},           {"on", SwitchLight{"night", true}},
      {"sun dimmed", ScaleLight{"sun", 0.2f}},        {"sky coloured", ColourLight{"sky", Rgb(0.5f, 0.7f, 0.9f)}},
      {"dimmed to nothing", ScaleLight{"ceiling", 0}}};
  for (const auto& [name, edit] : edits) {
    engine.apply(edit);
    EXPECT_EQ(engine.update().rays, 0u) << name;
    expectFresh(engine, name);
  }
}

TEST(LightDimming, FollowsMotionAndMotionFollowsIt) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  const std::string object = editableOfFurnishedRoom().objects.front(), lamp = editableOfFurnishedRoom().lights.front();
  for (int i = 0; i < 3; ++i) {
    engine.apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0.05, 0.02, 0))});
    engine.update();
    engine.apply(ScaleLight{lamp, 0.7f});
    EXPECT_EQ(engine.update().rays, 0u);
  }
  expectFresh(engine, "six edits");
}

TEST(LightDimming, LightOfAllIsTheSumOfEach) {
  Engine engine(roomOfManyLights(), coarse());
  engine.solve();
  const std::vector<Rgb> all = irradiance(engine);
  // Of what is left on: suns and skies that are off do not count, so they stay on.
  const std::vector<std::string> lamps{"ceiling", "reading", "night"};
  for (const std::string& lamp : lamps) engine.apply(SwitchLight{lamp, false});
  engine.update();
  const std::vector<Rgb> day = irradiance(engine);
  std::vector<Rgb> sum = day;
  for (const std::string& lamp : lamps) {
    engine.apply(SwitchLight{lamp, true});
    engine.update();
    const std::vector<Rgb> with = irradiance(engine);
    ASSERT_EQ(with.size(), sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += with[i] - day[i];
    engine.apply(SwitchLight{lamp, false});
    engine.update();
  }
  EXPECT_LT(difference(sum, all), 2e-3);
}

TEST(LightDimming, SamplesAreDecidedAnewWhereNightFalls) {
  Engine engine(roomOfManyLights(), coarse());
  engine.solve();
  const std::uint64_t day = hashOf(engine);
  engine.apply(SwitchLight{"sun", false});
  EXPECT_GT(engine.update().rays, 0u);
  expectFresh(engine, "without the sun");
  EXPECT_NE(hashOf(engine), day);
  engine.apply(ScaleLight{"sky", 0.001f});
  EXPECT_GT(engine.update().rays, 0u);
  expectFresh(engine, "dusk");
  engine.apply(SwitchLight{"sun", true});
  engine.apply(ScaleLight{"sky", 1000.0f});
  engine.update();
  EXPECT_EQ(hashOf(engine), day);
}

TEST(LightDimming, BrighterThanEverIsSampledAnew) {
  Engine engine(roomOfManyLights(), coarse());
  engine.solve();
  engine.apply(ScaleLight{"night", 20.0f});
  EXPECT_GT(engine.update().rays, 0u);
  expectFresh(engine, "brighter");
}

TEST(LightDimming, LightGoesOutForGood) {
  // Two rooms that share no light, of walls that keep four fifths of it.
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.8f));
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  addBox(scene, white, {10, 0, 0}, {14, 3, 2.5}, true);
  addLight(scene, PointLight{{2, 1.5, 2.3}, Rgb(5.0f)});
  addLight(scene, PointLight{{12, 1.5, 2.3}, Rgb(5.0f)});
  scene.lights[0].name = "here", scene.lights[1].name = "there";
  Engine engine(std::move(scene), coarse());
  engine.solve();
  const auto lightOf = [&](double from, double to) {
    const SolutionView view = engine.solution();
    const Solution& s = view.get();
    double sum = 0;
    for (const hierarchy::ElementId e : hierarchy::LeafTable(s.elements).leaves)
      if (s.elements.shape(e).lower.x >= from && s.elements.shape(e).upper.x <= to)
        sum += s.elements.shape(e).area * gray(s.elements.radiometry[e.index()].B);
    return sum;
  };
  const double here = lightOf(-1, 5), there = lightOf(9, 15);
  ASSERT_GT(here, 0);
  engine.apply(SwitchLight{"here", false});
  EXPECT_EQ(engine.update().rays, 0u);
  // After so many passes light is 1e-5 of what it was, and goes out; else each takes a fifth of it until floats hold no
  // less.
  EXPECT_LT(engine.solution().report().counts.iterations, 80u);
  EXPECT_EQ(lightOf(-1, 5), 0);
  EXPECT_NEAR(lightOf(9, 15), there, 1e-4 * there);
  engine.apply(SwitchLight{"there", false});
  engine.update();
  EXPECT_LT(engine.solution().report().counts.iterations, 10u);
  EXPECT_EQ(lightOf(-1, 15), 0);
}

TEST(LightDimming, FollowsInFramesWithoutARay) {
  Engine engine(roomOfManyLights(), coarse());
  engine.solve();
  engine.apply(ScaleLight{"ceiling", 0.5f});
  engine.apply(ScaleLight{"sky", 0.5f});
  EXPECT_EQ(engine.frame(20).rays, 0u);
  for (int i = 0; i < 40; ++i) engine.frame(20);
  const std::vector<Rgb> shown = irradiance(engine);
  engine.update();
  EXPECT_LT(difference(shown, irradiance(engine)), 2e-3);
  expectFresh(engine, "at rest");
}

}  // namespace
}  // namespace deltalux
