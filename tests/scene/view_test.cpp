#include <gtest/gtest.h>
#include <deltalux/view.hpp>

namespace deltalux {
namespace {

TEST(ViewRay, CentreGoesAlongTheViewAndEdgesSpanItsAngles) {
  View view;
  view.position = {1, 2, 3};
  view.direction = {0, 3, 0};
  view.horizontal = 90, view.vertical = 60;
  EXPECT_NEAR(glm::distance(viewRay(view, 0.5, 0.5).direction, Vec3(0, 1, 0)), 0, 1e-12);
  const Vec3 left = viewRay(view, 0, 0.5).direction, right = viewRay(view, 1, 0.5).direction;
  EXPECT_LT(left.x, 0);
  EXPECT_NEAR(std::acos(glm::dot(left, right)), glm::radians(90.0), 1e-12);
  const Vec3 top = viewRay(view, 0.5, 0).direction, bottom = viewRay(view, 0.5, 1).direction;
  EXPECT_GT(top.z, 0);
  EXPECT_NEAR(std::acos(glm::dot(top, bottom)), glm::radians(60.0), 1e-12);
  EXPECT_EQ(viewRay(view, 0.1, 0.9).origin, view.position);
}

TEST(ViewRay, ParallelMovesTheOrigin) {
  View view;
  view.kind = View::Kind::Parallel;
  view.direction = {0, 0, -1}, view.up = {0, 1, 0};
  view.horizontal = 4, view.vertical = 2;
  const ViewRay corner = viewRay(view, 1, 0);
  EXPECT_NEAR(glm::distance(corner.origin, Vec3(2, 1, 0)), 0, 1e-12);
  EXPECT_EQ(corner.direction, Vec3(0, 0, -1));
}

TEST(FitResolution, KeepsTheViewsAspect) {
  View view;
  view.horizontal = 90, view.vertical = 53.13010235415598;  // tangents 1 and 1/2
  EXPECT_EQ(fitResolution(view, 512, 512), glm::ivec2(512, 256));
  EXPECT_EQ(fitResolution(view, 512, 100), glm::ivec2(200, 100));
}

}  // namespace
}  // namespace deltalux
