#include <gtest/gtest.h>

#include <deltalux/probe.hpp>

namespace deltalux {
namespace {

void addSquare(Scene& scene, Surface surface, double z, double halfSide, bool up) {
  const double s = halfSide;
  std::vector<Vec3> corners{{-s, -s, z}, {s, -s, z}, {s, s, z}, {-s, s, z}};
  if (!up) std::reverse(corners.begin(), corners.end());
  scene.materials.push_back({"material", std::move(surface), std::nullopt});
  scene.primitives.push_back(
      {*makePolygon(corners), MaterialId(scene.materials.size() - 1), internObject(scene, "square", '.')});
}

/// Straight down from (0, 0, 4), parallel, 2 x 2 units over 4 x 4 pixels.
View downwards() {
  View view;
  view.kind = View::Kind::Parallel;
  view.position = {0, 0, 4};
  view.direction = {0, 0, -1};
  view.up = {0, 1, 0};
  view.horizontal = view.vertical = 2;
  return view;
}

TEST(VisiblePoints, LooksThroughPanesAndFacesTheEye) {
  for (const bool up : {true, false}) {
    Scene scene;
    addSquare(scene, Opaque{Rgb(0.5f), {}, {}}, 0, 0.5, up);
    addSquare(scene, ThinGlass{}, 1, 5, up);
    addSquare(scene, ThinGlass{}, 2, 5, !up);
    const auto seen = visiblePoints(scene, downwards(), 4, 4);
    ASSERT_EQ(seen.size(), 16u);
    for (std::size_t i = 0; i < 16; ++i) {
      const bool inside = i % 4 % 3 != 0 && i / 4 % 3 != 0;  // the square covers the middle 2 x 2 pixels
      ASSERT_EQ(seen[i].has_value(), inside) << i;
      if (!inside) continue;
      EXPECT_NEAR(seen[i]->position.z, 0.0, 1e-5);
      EXPECT_NEAR(seen[i]->normal.z, 1.0, 1e-6);
    }
    EXPECT_NEAR(seen[5]->position.x, -0.25, 1e-5);  // rows from the top, pixels from the left
    EXPECT_NEAR(seen[5]->position.y, 0.25, 1e-5);
  }
}

TEST(VisiblePoints, MirrorsAreSurfacesThemselves) {
  Scene scene;
  addSquare(scene, Mirror{Rgb(1.0f)}, 1, 5, true);
  for (const auto& point : visiblePoints(scene, downwards(), 2, 2)) {
    ASSERT_TRUE(point);
    EXPECT_NEAR(point->position.z, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace deltalux
