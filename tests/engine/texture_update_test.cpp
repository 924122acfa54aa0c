// Caustic textures follow edits: what changed is made anew and equals a fresh solve's, the rest is not touched.
#include <gtest/gtest.h>

#include "support/solved.hpp"

namespace deltalux {
namespace {

/// A room with two mirrors on its floor: each throws the light of its spot onto a wall of its own. `blocker` hangs over
/// the first one's beam; `pebble` lies in a corner.
Scene roomWithTwoMirrors() {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.5f));
  const MaterialId mirror = test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)});
  test::addBox(scene, white, Vec3(0), {3, 3, 2.5}, true);
  const auto pane = [&](double x, double y) {
    test::addPolygon(
        scene, mirror,
        {{x - 0.2, y - 0.2, 0.01}, {x + 0.2, y - 0.2, 0.01}, {x + 0.2, y + 0.2, 0.01}, {x - 0.2, y + 0.2, 0.01}});
  };
  pane(0.8, 1.5), pane(2.2, 1.5);
  const std::size_t blocker = scene.primitives.size();
  test::addBox(scene, white, {0.77, 2.17, 1.75}, {0.82, 2.22, 1.8}, false);
  const std::size_t pebble = scene.primitives.size();
  test::addBox(scene, white, {2.9, 0.05, 0.01}, {2.92, 0.07, 0.03}, false);
  const ObjectId room = internObject(scene, "room", '.'), over = internObject(scene, "blocker", '.'),
                 corner = internObject(scene, "pebble", '.');
  for (std::size_t i = 0; i < scene.primitives.size(); ++i)
    scene.primitives[i].object = i >= pebble ? corner : i >= blocker ? over : room;
  test::addLight(scene, SpotLight{{0.8, 0.3, 1.0}, glm::normalize(Vec3(0, 1.2, -1)), Rgb(30.0f), 0.999, 0.995});
  test::addLight(scene, SpotLight{{2.2, 2.7, 1.0}, glm::normalize(Vec3(0, -1.2, -1)), Rgb(30.0f), 0.999, 0.995});
  scene.lights[0].name = "first", scene.lights[1].name = "second";
  return scene;
}

Edit move(const std::string& object, const Vec3& by) {
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(by, 1.0);
  return TransformObject{object, matrix};
}

std::size_t wallAt(const Scene& scene, double y) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Box box = bounds(scene.primitives[i].shape);
    if (std::abs(box.lower.y - y) + std::abs(box.upper.y - y) < 1e-9) return i;
  }
  throw std::logic_error("no such wall");
}

const caustics::SurfaceCaustics* texturesOf(const Engine& engine, double y) {
  const Solution& s = engine.solution().get();
  return s.caustics.of(PrimitiveId(wallAt(s.scene, y)), true);
}

bool identical(const caustics::SurfaceCaustics& a, const caustics::SurfaceCaustics& b) {
  if (a.textures.size() != b.textures.size()) return false;
  for (std::size_t i = 0; i < a.textures.size(); ++i)
    if (a.textures[i].texels != b.textures[i].texels || a.textures[i].areas != b.textures[i].areas) return false;
  return true;
}

/// Root mean square difference over a wall, relative to that of the light itself.
double difference(const caustics::SurfaceCaustics& a, const caustics::SurfaceCaustics& b, const Shape& wall) {
  double squares = 0, light = 0;
  constexpr int n = 200;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const SurfacePoint p = pointAt(wall, {(x + 0.5) / n, (y + 0.5) / n});
      const double E = gray(b.irradianceAt(p)), d = gray(a.irradianceAt(p)) - E;
      squares += d * d, light += E * E;
    }
  return std::sqrt(squares / light);
}

Engine solvedRoom(const Scene& scene) {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000;
  Engine engine(scene, settings);
  engine.solve();
  return engine;
}

TEST(TextureUpdate, RebuildsWhatTheEditChangedAndNothingElse) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  ASSERT_TRUE(texturesOf(engine, 0) && texturesOf(engine, 3));
  const caustics::SurfaceCaustics untouched = *texturesOf(engine, 0), before = *texturesOf(engine, 3);
  engine.apply(move("blocker", {0, 0, -1.2}));
  const StepReport step = engine.update();
  const caustics::SurfaceCaustics &after = *texturesOf(engine, 3), &other = *texturesOf(engine, 0);
  EXPECT_TRUE(identical(other, untouched));
  EXPECT_GE(step.texturesRebuilt, after.textures.size());
  EXPECT_LE(step.texturesRebuilt, engine.solution().get().caustics.count() - other.textures.size());
  EXPECT_NO_THROW(validate(engine.solution().get().caustics));

  const Engine fresh = solvedRoom(engine.solution().scene());
  ASSERT_TRUE(texturesOf(fresh, 0) && texturesOf(fresh, 3));
  const Shape& wall = engine.solution().scene()[after.primitive].shape;
  EXPECT_GT(difference(after, before, wall), 0.1);
  EXPECT_LT(difference(after, *texturesOf(fresh, 3), wall), 0.01);
  EXPECT_LT(difference(other, *texturesOf(fresh, 0), engine.solution().scene()[other.primitive].shape), 0.01);
}

TEST(TextureUpdate, OutAndBackIsWhereItWas) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  const caustics::SurfaceCaustics before = *texturesOf(engine, 3);
  engine.apply(move("blocker", {0, 0, -1.2}));
  engine.update();
  engine.apply(move("blocker", {0, 0, 1.2}));
  EXPECT_GT(engine.update().texturesRebuilt, 0u);
  EXPECT_LT(difference(*texturesOf(engine, 3), before, engine.solution().scene()[before.primitive].shape), 0.01);
}

TEST(TextureUpdate, WhatHappensElsewhereRebuildsNone) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  const caustics::SurfaceCaustics first = *texturesOf(engine, 3), second = *texturesOf(engine, 0);
  engine.apply(move("pebble", {-0.03, 0.02, 0}));
  EXPECT_EQ(engine.update().texturesRebuilt, 0u);
  EXPECT_TRUE(identical(*texturesOf(engine, 3), first));
  EXPECT_TRUE(identical(*texturesOf(engine, 0), second));
}

TEST(TextureUpdate, DimmedLampsScaleTheirTextures) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  const caustics::SurfaceCaustics first = *texturesOf(engine, 3), second = *texturesOf(engine, 0);
  engine.apply(ScaleLight{"first", 0.25f});
  engine.apply(ScaleLight{"second", 0.25f});
  EXPECT_EQ(engine.update().texturesRebuilt, 0u);
  for (const auto& [then, y] : {std::pair{&first, 3.0}, std::pair{&second, 0.0}}) {
    const caustics::SurfaceCaustics& now = *texturesOf(engine, y);
    ASSERT_EQ(now.textures.size(), then->textures.size());
    EXPECT_NEAR(now.flux().r / then->flux().r, 0.25, 1e-3);
    for (std::size_t i = 0; i < now.textures[0].texels.size(); ++i)
      EXPECT_NEAR(now.textures[0].texels[i].r, 0.25f * then->textures[0].texels[i].r,
                  1e-3f * then->textures[0].texels[i].r);
  }
  EXPECT_NO_THROW(validate(engine.solution().get().caustics));
}

TEST(TextureUpdate, ALampAloneIsFollowedByItsOwnTexture) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  engine.apply(ScaleLight{"first", 0.25f});
  engine.update();
  const Engine fresh = solvedRoom(engine.solution().scene());
  for (const double y : {0.0, 3.0}) {
    ASSERT_TRUE(texturesOf(engine, y) && texturesOf(fresh, y));
    const caustics::SurfaceCaustics& now = *texturesOf(engine, y);
    EXPECT_LT(difference(now, *texturesOf(fresh, y), engine.solution().scene()[now.primitive].shape), 0.02) << y;
  }
  engine.apply(SwitchLight{"first", false});
  engine.update();
  engine.apply(SwitchLight{"first", true});
  engine.update();
  ASSERT_TRUE(texturesOf(engine, 3));
  const caustics::SurfaceCaustics& back = *texturesOf(engine, 3);
  EXPECT_LT(difference(back, *texturesOf(fresh, 3), engine.solution().scene()[back.primitive].shape), 0.02);
}

TEST(TextureUpdate, ManySmallStepsDoNotCreep) {
  Engine engine = solvedRoom(roomWithTwoMirrors());
  for (int i = 0; i < 6; ++i) {
    engine.apply(move("blocker", {0.01, 0, -0.2}));
    engine.update();
    ASSERT_NO_THROW(validate(engine.solution().get().caustics));
  }
  const Engine fresh = solvedRoom(engine.solution().scene());
  const caustics::SurfaceCaustics& now = *texturesOf(engine, 3);
  EXPECT_LT(difference(now, *texturesOf(fresh, 3), engine.solution().scene()[now.primitive].shape), 0.02);
}

}  // namespace
}  // namespace deltalux
