// Handles of the gizmo: from rays to maps.
#include "gizmo.hpp"

#include <gtest/gtest.h>

#include "camera.hpp"

using namespace deltalux;
using namespace deltalux::viewer;

namespace {
/// The ray from an eye through a point.
ViewRay towards(const Vec3& eye, const Vec3& p) { return {eye, glm::normalize(p - eye)}; }

Vec3 apply(const Mat4& m, const Vec3& p) { return Vec3(m * glm::dvec4(p, 1)); }

void expectNear(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " is not " << b.x << ' ' << b.y << ' ' << b.z;
}

/// Axes that are none of the world's.
glm::dmat3 oblique() { return glm::dmat3(rotationAbout(Vec3(0), glm::normalize(Vec3(1, 2, 3)), 40)); }

const Vec3 kEye(3, -7, 5);
}  // namespace

TEST(Gizmo, FindsThePointOfALineThatIsNearestToARay) {
  const Vec3 point(1, 2, 3), direction(0.6, 0, 0.8);
  const auto t = alongLine(towards(kEye, point + 2.5 * direction), point, direction);
  ASSERT_TRUE(t);
  EXPECT_NEAR(*t, 2.5, 1e-12);
  // A ray that passes the line at a distance: the connection stands across both.
  const ViewRay skew{{0, 0, 1}, {0, 1, 0}};
  const auto s = alongLine(skew, {-4, 5, 0}, {2, 0, 0});
  ASSERT_TRUE(s);
  EXPECT_NEAR(*s, 2, 1e-12);
  EXPECT_FALSE(alongLine({kEye, direction}, point, direction));
}

TEST(Gizmo, MeetsPlanesInFrontOfTheEyeAlone) {
  const auto p = onPlane(towards(kEye, {1, 1, 0}), Vec3(0), {0, 0, 1});
  ASSERT_TRUE(p);
  expectNear(*p, {1, 1, 0});
  EXPECT_FALSE(onPlane({kEye, {0, 0, 1}}, Vec3(0), {0, 0, 1}));
  EXPECT_FALSE(onPlane({kEye, {1, 0, 0}}, Vec3(0), {0, 0, 1}));
}

TEST(Gizmo, MovesAlongAnAxisByAsMuchAsTheHand) {
  const Gizmo g{{1, 0.5, -1}, oblique(), 1};
  for (const Handle h : {Handle::MoveX, Handle::MoveY, Handle::MoveZ}) {
    const Vec3 axis = g.axes[axisOf(h)];
    const auto drag =
        dragged(g, h, towards(kEye, g.centre + 0.8 * axis), towards(kEye, g.centre + 2.05 * axis), Snap{});
    ASSERT_TRUE(drag);
    expectNear(apply(drag->matrix, {4, 4, 4}), Vec3(4) + 1.25 * axis);
    EXPECT_NEAR(drag->offset[axisOf(h)], 1.25, 1e-9);
  }
}

TEST(Gizmo, MovesInAPlaneWithWhatIsHeldUnderTheCursor) {
  const Gizmo g{{1, 0.5, -1}, oblique(), 1};
  for (const Handle h : {Handle::MoveYZ, Handle::MoveZX, Handle::MoveXY}) {
    const int axis = axisOf(h);
    const Vec3 u = g.axes[(axis + 1) % 3], v = g.axes[(axis + 2) % 3];
    const Vec3 from = g.centre + 0.4 * u + 0.4 * v, to = g.centre + 1.1 * u - 0.3 * v;
    const auto drag = dragged(g, h, towards(kEye, from), towards(kEye, to), Snap{});
    ASSERT_TRUE(drag);
    expectNear(apply(drag->matrix, from), to);
    EXPECT_EQ(drag->offset[axis], 0);
  }
}

TEST(Gizmo, TurnsAboutItsCentreByTheAngleOfTheHand) {
  const Gizmo g{{1, 0.5, -1}, oblique(), 1};
  for (const Handle h : {Handle::TurnX, Handle::TurnY, Handle::TurnZ}) {
    const int axis = axisOf(h);
    const Vec3 u = g.axes[(axis + 1) % 3], v = g.axes[(axis + 2) % 3];
    const double angle = glm::radians(70.0);
    const Vec3 to = g.centre + std::cos(angle) * u + std::sin(angle) * v;
    const auto drag = dragged(g, h, towards(kEye, g.centre + u), towards(kEye, to), Snap{});
    ASSERT_TRUE(drag);
    EXPECT_NEAR(drag->degrees, 70, 1e-9);
    expectNear(apply(drag->matrix, g.centre + u), to);
    expectNear(apply(drag->matrix, g.centre), g.centre);
    expectNear(apply(drag->matrix, g.centre + g.axes[axis]), g.centre + g.axes[axis]);
  }
}

TEST(Gizmo, TurnsByTheTangentWhereARingIsSeenEdgeOn) {
  const Gizmo g{Vec3(0), glm::dmat3(1.0), 1};
  const Vec3 eye(0, -10, 0);  // the ring about z is a line from here
  const auto right = dragged(g, Handle::TurnZ, towards(eye, {0, 0, 0.01}), towards(eye, {0.3, 0, 0.01}), Snap{});
  ASSERT_TRUE(right);
  EXPECT_GT(right->degrees, 10);  // what is on the eye's side goes to the right: counter-clockwise from above
  const auto left = dragged(g, Handle::TurnZ, towards(eye, {0, 0, 0.01}), towards(eye, {-0.3, 0, 0.01}), Snap{});
  ASSERT_TRUE(left);
  EXPECT_NEAR(left->degrees, -right->degrees, 1e-9);
}

TEST(Gizmo, SnapsToStepsOfTheWayAndOfTheAngle) {
  const Gizmo g{{1, 0.5, -1}, oblique(), 1};
  const Snap snap{0.1, 5};
  const auto moved =
      dragged(g, Handle::MoveX, towards(kEye, g.centre), towards(kEye, g.centre + 0.83 * g.axes[0]), snap);
  ASSERT_TRUE(moved);
  EXPECT_NEAR(moved->offset.x, 0.8, 1e-12);
  expectNear(apply(moved->matrix, g.centre), g.centre + 0.8 * g.axes[0]);
  const double angle = glm::radians(33.0);
  const Vec3 to = g.centre + std::cos(angle) * g.axes[0] + std::sin(angle) * g.axes[1];
  const auto turned = dragged(g, Handle::TurnZ, towards(kEye, g.centre + g.axes[0]), towards(kEye, to), snap);
  ASSERT_TRUE(turned);
  EXPECT_NEAR(turned->degrees, 35, 1e-12);
}

TEST(Gizmo, SaysNothingWhereTheHandPointsNowhere) {
  const Gizmo g{Vec3(0), glm::dmat3(1.0), 1};
  const ViewRay from = towards(kEye, {0.4, 0.4, 0});
  EXPECT_FALSE(dragged(g, Handle::MoveXY, from, {kEye, {0, 0, 1}}, Snap{}));
  EXPECT_FALSE(dragged(g, Handle::MoveX, from, {kEye, {1, 0, 0}}, Snap{}));
  EXPECT_FALSE(dragged(g, Handle::None, from, from, Snap{}));
}

TEST(Gizmo, KeepsAMapsMeaningInTheCoordinatesOfFiles) {
  const Vec3 origin(1e6, 2e6, 300);
  const Mat4 map = rotationAbout({1, 2, 3}, {0, 0, 1}, 90);
  const Vec3 p(4, 5, 6);
  expectNear(apply(inFiles(map, origin), p + origin), apply(map, p) + origin, 1e-6);
}

TEST(Gizmo, FindsTheHandleUnderTheCursor) {
  View view;
  view.position = kEye, view.direction = -kEye, view.horizontal = 40, view.vertical = 30;
  const Gizmo g = gizmoAt(Vec3(0), glm::dmat3(1.0), view);
  constexpr int kWidth = 800, kHeight = 600;
  const auto at = [&](const Vec3& p) {
    const Vec3 pixel = project(view, kWidth, kHeight, p);
    return handleAt(g, view, kWidth, kHeight, pixel.x, pixel.y, 6);
  };
  for (const Handle h : {Handle::MoveX, Handle::MoveY, Handle::MoveZ}) EXPECT_EQ(at(outline(g, h).back()), h);
  for (const Handle h : {Handle::MoveYZ, Handle::MoveZX, Handle::MoveXY}) {
    const std::vector<Vec3> square = outline(g, h);
    EXPECT_EQ(at(0.5 * (square[0] + square[2])), h);
  }
  EXPECT_EQ(at(outline(g, Handle::TurnZ)[5]), Handle::TurnZ);
  EXPECT_EQ(at({3 * g.size, 0, 0}), Handle::None);
}
