#include "camera.hpp"

#include <gtest/gtest.h>

namespace deltalux::viewer {
namespace {

View aView(View::Kind kind = View::Kind::Perspective) {
  View view;
  view.kind = kind;
  view.position = {1, -3, 2};
  view.direction = {0.3, 1, -0.2};
  view.horizontal = kind == View::Kind::Parallel ? 4 : 60;
  view.vertical = kind == View::Kind::Parallel ? 3 : 45;
  return view;
}

constexpr int kWidth = 640, kHeight = 480;

TEST(ViewerCamera, ProjectingUndoesTheRayThroughAPixel) {
  for (const auto kind : {View::Kind::Perspective, View::Kind::Parallel}) {
    const View view = aView(kind);
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {12.5, 470.0}, {320.0, 240.0}, {639.5, 3.25}}) {
      const ViewRay ray = rayThrough(view, kWidth, kHeight, x, y);
      for (const double distance : {0.5, 7.0}) {
        const Vec3 there = project(view, kWidth, kHeight, ray.origin + distance * ray.direction);
        EXPECT_NEAR(there.x, x, 1e-8);
        EXPECT_NEAR(there.y, y, 1e-8);
        EXPECT_GT(there.z, 0);
      }
    }
  }
  EXPECT_LT(project(aView(), kWidth, kHeight, Vec3(1, -10, 2)).z, 0);
}

TEST(ViewerCamera, OrbitKeepsThePivotWhereItIsInThePicture) {
  for (const auto kind : {View::Kind::Perspective, View::Kind::Parallel}) {
    View view = aView(kind);
    const Vec3 pivot(2.5, 1.5, 0.25);
    const Vec3 before = project(view, kWidth, kHeight, pivot);
    for (int i = 0; i < 20; ++i) orbit(view, pivot, 0.3, 0.11);
    const Vec3 after = project(view, kWidth, kHeight, pivot);
    EXPECT_NEAR(after.x, before.x, 1e-7);
    EXPECT_NEAR(after.y, before.y, 1e-7);
    EXPECT_NEAR(after.z, before.z, 1e-9);
    EXPECT_GT(glm::length(view.position - aView().position), 1);
  }
}

TEST(ViewerCamera, TurningStaysShortOfStraightUp) {
  View view = aView();
  turn(view, 0, 100);
  EXPECT_NEAR(glm::degrees(std::asin(glm::normalize(view.direction).z)), 89, 1e-6);
  turn(view, 0, -100);
  EXPECT_NEAR(glm::degrees(std::asin(glm::normalize(view.direction).z)), -89, 1e-6);
  View left = aView();
  left.direction = {0, 1, 0};
  turn(left, kPi / 2, 0);
  EXPECT_NEAR(left.direction.x, -1, 1e-12);
}

TEST(ViewerCamera, LevelWalkingStaysAtItsHeight) {
  View view = aView();
  move(view, {0.5, 2, 0}, true);
  EXPECT_NEAR(view.position.z, 2, 1e-12);
  const Vec3 step = view.position - aView().position;
  EXPECT_NEAR(glm::length(step), std::hypot(0.5, 2), 1e-12);
  EXPECT_GT(glm::dot(step, view.direction), 0);
  View flying = aView();
  move(flying, {0, 2, 0}, false);
  EXPECT_NEAR(glm::length(glm::cross(flying.position - aView().position, flying.direction)), 0, 1e-12);
}

TEST(ViewerCamera, DollyHalvesTheDistanceAndKeepsThePointInPlace) {
  for (const auto kind : {View::Kind::Perspective, View::Kind::Parallel}) {
    View view = aView(kind);
    const Vec3 point(2, 2, 0);
    const Vec3 before = project(view, kWidth, kHeight, point);
    dolly(view, point, 0.5);
    const Vec3 after = project(view, kWidth, kHeight, point);
    EXPECT_NEAR(after.x, before.x, 1e-8);
    EXPECT_NEAR(after.y, before.y, 1e-8);
    if (kind == View::Kind::Perspective) {
      EXPECT_NEAR(after.z, before.z / 2, 1e-9);
    }
  }
}

TEST(ViewerCamera, FocusShowsAllCornersOfTheBox) {
  Box box;
  box.extend(Vec3(-1, 2, 0)), box.extend(Vec3(3, 4, 1));
  for (const auto kind : {View::Kind::Perspective, View::Kind::Parallel}) {
    View view = aView(kind);
    focus(view, box);
    double furthest = 0;  // from the middle of the picture, in half sizes
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? box.lower.x : box.upper.x, i & 2 ? box.lower.y : box.upper.y,
                        i & 4 ? box.lower.z : box.upper.z);
      const Vec3 p = project(view, kWidth, kHeight, corner);
      EXPECT_GT(p.z, 0);
      furthest = std::max({furthest, std::abs(p.x / (kWidth / 2) - 1), std::abs(p.y / (kHeight / 2) - 1)});
    }
    EXPECT_LE(furthest, 1);
    EXPECT_GT(furthest, 0.4);
  }
}

TEST(ViewerCamera, FittedPixelsAreSquareAndTheLargerAngleStays) {
  const View wide = fitted(aView(), 800, 200);
  EXPECT_NEAR(wide.horizontal, 60, 1e-9);
  EXPECT_NEAR(std::tan(glm::radians(wide.horizontal) / 2) / std::tan(glm::radians(wide.vertical) / 2), 4, 1e-9);
  const View tall = fitted(aView(), 200, 400);
  EXPECT_NEAR(tall.vertical, 60, 1e-9);
}

TEST(ViewerCamera, FirstViewStandsInsideAtEyeHeight) {
  Scene scene;
  scene.metresPerUnit = 0.5;
  scene.materials.emplace_back();
  const auto floor = makePolygon({{0, 0, 0}, {20, 0, 0}, {20, 10, 0}, {0, 10, 0}});
  const auto wall = makePolygon({{0, 0, 0}, {20, 0, 0}, {20, 0, 8}, {0, 0, 8}});
  ASSERT_TRUE(floor && wall);
  for (const auto& shape : {*floor, *wall}) scene.primitives.push_back({shape, MaterialId(0), ObjectId()});
  const View view = firstView(scene);
  EXPECT_TRUE(bounds(scene).contains(view.position));
  EXPECT_NEAR(view.position.z, 1.6 / 0.5, 1e-12);
  const Vec3 middle = project(view, kWidth, kHeight, bounds(scene).center());
  EXPECT_NEAR(middle.x, kWidth / 2, 1e-6);
  EXPECT_NEAR(middle.y, kHeight / 2, 1e-6);
}

}  // namespace
}  // namespace deltalux::viewer
