// Light that settles where it has changed is the light that all rows and particles give.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "base/parallel.hpp"
#include "support/settled.hpp"

namespace deltalux {
namespace {

/// A room with a mirror, a glass ball, a sheet of paper that light shines through, two lamps and a box.
Scene room() {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.6f));
  const MaterialId red = test::addMaterial(scene, "red", Opaque{Rgb(0.6f, 0.2f, 0.1f), {}, {}});
  const MaterialId mirror = test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)});
  const MaterialId glass = test::addMaterial(scene, "glass", Dielectric{Rgb(0.95f), 1.5f});
  const MaterialId paper = test::addMaterial(scene, "paper", Trans{Rgb(0.3f), Rgb(0.4f), {}, {}});
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(20.0f), false, {}});
  const MaterialId other = test::addMaterial(scene, "other", test::lambert(0.0f), Emission{Rgb(5.0f), false, {}});
  test::addBox(scene, white, {0, 0, 0}, {3, 4, 2.5}, true);
  test::addBox(scene, red, {1.0, 1.2, 0.0}, {1.5, 1.8, 0.9}, false);
  test::addPolygon(scene, mirror, {{0.01, 1, 0.5}, {0.01, 1, 2}, {0.01, 3, 2}, {0.01, 3, 0.5}});
  test::addShape(scene, glass, Sphere{{2.2, 2.6, 0.4}, 0.3, false});
  test::addPolygon(scene, paper, {{2.5, 0.5, 0.5}, {2.5, 1.5, 0.5}, {2.5, 1.5, 1.5}, {2.5, 0.5, 1.5}});
  test::addPolygon(scene, lamp, {{1.2, 1.7, 2.4}, {1.2, 2.3, 2.4}, {1.8, 2.3, 2.4}, {1.8, 1.7, 2.4}});
  test::addPolygon(scene, other, {{2.6, 3.4, 2.4}, {2.6, 3.8, 2.4}, {2.9, 3.8, 2.4}, {2.9, 3.4, 2.4}});
  const char* names[] = {"walls", "box", "mirror", "ball", "paper", "lamp", "other"};
  const std::size_t ends[] = {6, 12, 13, 14, 15, 16, 17};
  for (std::size_t i = 0, name = 0; i < scene.primitives.size(); ++i) {
    if (i >= ends[name]) ++name;
    scene.primitives[i].object = internObject(scene, names[name], '.');
  }
  addAreaLights(scene);
  return scene;
}

SolveSettings settings() {
  SolveSettings settings;
  settings.error = 0.1, settings.particles = 40000;
  return settings;
}

Edit shift(const std::string& object, const Vec3& by) { return TransformObject{object, glm::translate(Mat4(1.0), by)}; }
Edit dim(const Engine& engine, std::size_t light, float scale) {
  return ScaleLight{engine.solution().scene().lights[light].name, scale};
}

void expectSettled(const Engine& engine, const char* after) {
  const test::Unsettled u = test::unsettled(engine.solution().get());
  EXPECT_LT(u.power, 5e-4) << after;
  EXPECT_LT(u.relative.median, 1e-3) << after;
  EXPECT_LT(u.relative.p95, 5e-3) << after;
}

TEST(LightSettling, IsTheLightOfAllRowsAndParticles) {
  Engine engine(room(), settings());
  engine.solve();
  ASSERT_GT(engine.solution().get().report.counts.particles, 1000u);
  expectSettled(engine, "the solve");
  const std::pair<const char*, Edit> edits[] = {
      {"a box that moves", shift("box", {0.3, 0.2, 0})},
      {"a mirror that moves", shift("mirror", {0.2, 0.1, 0})},
      {"a lamp that is dimmed", dim(engine, 0, 0.3f)},
      {"a glass ball that moves", shift("ball", {-0.4, 0, 0.5})},
      {"other walls", SetMaterial{"white", Rgb(0.3f, 0.5f, 0.4f), {}}},
      {"other paper", SetMaterial{"paper", Rgb(0.1f, 0.2f, 0.1f), {}}},
      {"a lamp that is switched off", SwitchLight{engine.solution().scene().lights[1].name, false}},
      {"a lamp that moves", shift("lamp", {0.5, -0.5, 0})},
      {"a box that goes", RemoveObject{"box"}},
      {"a brighter lamp", dim(engine, 0, 1.2f)},
  };
  for (const auto& [what, edit] : edits) {
    engine.apply(edit);
    engine.update();
    expectSettled(engine, what);
  }
}

TEST(LightSettling, GoesOnAfterFrames) {
  Engine engine(room(), settings());
  engine.solve();
  for (int i = 0; i < 4; ++i) {
    engine.apply(shift("ball", {-0.1, 0, 0.05}));
    engine.frame(20);
  }
  engine.update();
  expectSettled(engine, "a drag");
  engine.apply(shift("box", {0.2, 0.2, 0}));
  engine.update();
  expectSettled(engine, "an update after a drag");
}

TEST(LightSettling, DoesNotDependOnTheThreadCount) {
  std::vector<std::vector<Rgb>> light;
  for (const std::size_t threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    Engine engine(room(), settings());
    engine.solve();
    for (const Edit& edit : {shift("box", {0.3, 0.2, 0}), dim(engine, 0, 0.3f), shift("ball", {-0.4, 0, 0.5})}) {
      engine.apply(edit);
      engine.update();
    }
    light.emplace_back();
    for (const hierarchy::ElementLight& l : engine.solution().get().elements.radiometry) light.back().push_back(l.B);
  }
  EXPECT_EQ(light[0], light[1]);
}

TEST(LightSettling, LeavesAnotherRoomAlone) {
  Scene scene = room();
  const MaterialId grey = test::addMaterial(scene, "grey", test::lambert(0.5f));
  const std::size_t first = scene.primitives.size();
  test::addBox(scene, grey, {5, 0, 0}, {8, 4, 2.5}, true);
  for (std::size_t i = first; i < scene.primitives.size(); ++i)
    scene.primitives[i].object = internObject(scene, "next", '.');
  test::addLight(scene, PointLight{{6, 2, 1.5}, Rgb(2.0f)});
  Engine engine(std::move(scene), settings());
  engine.solve();
  const auto next = [&] {
    const hierarchy::Elements& e = engine.solution().get().elements;
    std::vector<float> B;
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e.isReceivingLeaf(hierarchy::ElementId(i)) && e.domain[i].primitive.index() >= first)
        B.push_back(gray(e.radiometry[i].B));
    return B;
  };
  const std::vector<float> before = next();
  EXPECT_GT(before.size(), 20u);
  for (const Edit& edit : {shift("box", {0.3, 0.2, 0}), dim(engine, 0, 0.3f), shift("mirror", {0.2, 0.1, 0})}) {
    engine.apply(edit);
    engine.update();
    const std::vector<float> after = next();
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t i = 0; i < after.size(); ++i) EXPECT_NEAR(after[i], before[i], 1e-5f * before[i]);
  }
}

}  // namespace
}  // namespace deltalux
