// Rectangles of meters, measured out by two points.
#include "meter_rectangle.hpp"

#include <gtest/gtest.h>

using namespace deltalux;
using namespace deltalux::viewer;

namespace {
SurfaceHit hit(const Vec3& p, const Vec3& n) {
  SurfaceHit h;
  h.position = p, h.normal = n;
  return h;
}
}  // namespace

TEST(MeterRectangle, SpansARectangleOnTheFloorAlongTheAxes) {
  const auto field = fieldBetween(hit({1, 2, 0}, {0, 0, 1}), {4, 0.5, 0}, {0, 0, 1});
  ASSERT_TRUE(field);
  EXPECT_LT(glm::length(field->corner + field->across + field->along - Vec3(4, 0.5, 0)), 1e-12);
  EXPECT_NEAR(std::abs(field->across.x), 3, 1e-12);
  EXPECT_NEAR(std::abs(field->along.y), 1.5, 1e-12);
}

TEST(MeterRectangle, SpansARectangleOnAWallLevelAndUpright) {
  const Vec3 n = glm::normalize(Vec3(1, 1, 0));
  const Vec3 level = glm::normalize(Vec3(-1, 1, 0));
  const auto field = fieldBetween(hit({0, 0, 1}, n), Vec3(0, 0, 2.5) + 2.0 * level, {0, 0, 1});
  ASSERT_TRUE(field);
  EXPECT_NEAR(glm::length(field->across), 2, 1e-12);
  EXPECT_NEAR(field->across.z, 0, 1e-12);
  EXPECT_NEAR(glm::length(field->along), 1.5, 1e-12);
  EXPECT_NEAR(std::abs(field->along.z), 1.5, 1e-12);
}

TEST(MeterRectangle, SpansNoneOverPointsOnALine) {
  EXPECT_FALSE(fieldBetween(hit({0, 0, 0}, {0, 0, 1}), {2, 0, 0}, {0, 0, 1}));
  EXPECT_FALSE(fieldBetween(hit({0, 0, 0}, {0, 0, 1}), {0, 0, 0}, {0, 0, 1}));
}
