// Walking by time.
#include "walk.hpp"

#include <gtest/gtest.h>

using namespace deltalux;
using namespace deltalux::viewer;

namespace {
/// Where one is after so long with a key held, in so many frames.
Vec3 walked(double seconds, int frames, bool fast = false) {
  Walk walk;
  View view;
  view.direction = {0, 1, 0};
  for (int i = 0; i < frames; ++i) walk.advance(view, {{0, 1, 0}, fast}, true, 2.0, seconds / frames);
  return view.position;
}
}  // namespace

TEST(Walk, GoesAsFarInManyFramesAsInFew) {
  EXPECT_NEAR(walked(1, 100).y, walked(1, 3).y, 1e-9);
  EXPECT_GT(walked(1, 10).y, 1.7);  // 2 units a second, less what getting to speed takes
  EXPECT_LT(walked(1, 10).y, 2.0);
  EXPECT_NEAR(walked(1, 10, true).y, 4 * walked(1, 10).y, 1e-9);
}

TEST(Walk, ComesToRestOnceTheKeyIsUp) {
  Walk walk;
  View view;
  EXPECT_FALSE(walk.advance(view, {}, true, 2.0, 0.02));
  EXPECT_FALSE(walk.moving());
  for (int i = 0; i < 10; ++i) walk.advance(view, {{1, 0, 0}, false}, true, 2.0, 0.02);
  EXPECT_TRUE(walk.moving());
  int frames = 0;
  while (walk.moving() && ++frames < 100) walk.advance(view, {}, true, 2.0, 0.02);
  EXPECT_LT(frames, 30);  // about five times the time of its ease
  const Vec3 there = view.position;
  walk.advance(view, {}, true, 2.0, 0.02);
  EXPECT_EQ(view.position, there);
}

TEST(Walk, KeepsItsHeightWhenLevel) {
  Walk walk;
  View level, flying;
  level.direction = flying.direction = glm::normalize(Vec3(0, 1, -1));
  walk.advance(level, {{0, 1, 0}, false}, true, 1.0, 0.5);
  EXPECT_NEAR(level.position.z, 0, 1e-12);
  EXPECT_GT(level.position.y, 0.1);
  Walk other;
  other.advance(flying, {{0, 1, 0}, false}, false, 1.0, 0.5);
  EXPECT_LT(flying.position.z, -0.1);
}

TEST(Walk, IsSlowerInScenesThatAreSmall) {
  Scene scene;
  scene.metresPerUnit = 0.001;  // millimetres
  EXPECT_NEAR(walkingSpeed(scene), 1500, 1e-9);
  Primitive ball;
  ball.shape = Sphere{Vec3(0), 10, false};
  scene.primitives.push_back(ball);
  EXPECT_LT(walkingSpeed(scene), 20);
}
