#include <deltalux/grid.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>

#include "support/rooms.hpp"

namespace deltalux {
namespace {

using namespace test;

TEST(MeasuringGrid, IsAsFineAsTheStandardSays) {
  // The table of examples in the standard, which rounds.
  for (const auto& [side, spacing] :
       {std::pair(1.0, 0.2), {2.0, 0.3}, {5.0, 0.6}, {10.0, 1.0}, {25.0, 2.0}, {50.0, 3.0}, {100.0, 5.0}})
    EXPECT_NEAR(gridSpacing(side, side), spacing, 0.1 * spacing) << side;
  EXPECT_DOUBLE_EQ(gridSpacing(1000, 900), 10);
  EXPECT_DOUBLE_EQ(gridSpacing(10, 6), gridSpacing(10, 10));
  EXPECT_DOUBLE_EQ(gridSpacing(10, 5), gridSpacing(5, 5));  // long areas: by the shorter side
  EXPECT_DOUBLE_EQ(gridSpacing(4, 30), gridSpacing(4, 4));
}

TEST(MeasuringGrid, LiesInTheMiddlesOfCellsWithinItsBorder) {
  const MeasuringGrid grid = gridOf({{1, 2, 0}, {6, 0, 0}, {0, 4, 0}}, 1, {.height = 0.75});
  // 5 x 3 m are left: p = 0.2 * 5^log10(5) = 0.616 m.
  EXPECT_EQ(grid.columns, 8);
  EXPECT_EQ(grid.rows, 5);
  ASSERT_EQ(grid.points.size(), 40u);
  EXPECT_NEAR(glm::distance(grid.points[0].position, Vec3(1.5 + 5.0 / 16, 2.5 + 0.3, 0.75)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(grid.points[39].position, Vec3(6.5 - 5.0 / 16, 5.5 - 0.3, 0.75)), 0, 1e-12);
  EXPECT_EQ(grid.points[7].normal, Vec3(0, 0, 1));
  // A desk's border is narrower, in a scene in millimetres.
  const MeasuringGrid desk = gridOf({{0, 0, 0}, {1600, 0, 0}, {0, 800, 0}}, 0.001, {});
  EXPECT_NEAR(glm::length(desk.area.u), 1600 - 240, 1e-9);
  EXPECT_NEAR(glm::length(desk.area.v), 800 - 240, 1e-9);
}

Scene tableAndWall() {
  Scene scene;
  const MaterialId paint = addMaterial(scene, "paint", lambert(0.5f));
  const auto object = [&](const char* name, std::size_t first) {
    scene.objects.push_back({name, ObjectId(0)});
    for (std::size_t i = first; i < scene.primitives.size(); ++i)
      scene.primitives[i].object = ObjectId(scene.objects.size() - 1);
  };
  if (scene.objects.empty()) scene.objects.push_back({"", ObjectId()});
  addBox(scene, paint, {0, 0, 0.7}, {2, 1, 0.75}, false);
  object("table", 0);
  std::size_t first = scene.primitives.size();
  addPolygon(scene, paint, {{0, 3, 0}, {0, 3, 2}, {4, 3, 2}, {4, 3, 0}});
  object("wall", first), first = scene.primitives.size();
  // Seen from below, and with a corner cut out.
  addPolygon(scene, paint, {{0, 0, 0}, {0, 4, 0}, {2, 4, 0}, {2, 1.9, 0}, {6, 1.9, 0}, {6, 0, 0}});
  object("floor", first);
  return scene;
}

TEST(MeasuringGrid, LiesOnTheTopOfAnObject) {
  const Scene scene = tableAndWall();
  const MeasuringGrid table = gridOn(scene, "table");
  for (const ProbePoint& p : table.points) {
    EXPECT_NEAR(p.position.z, 0.75, 1e-12);
    EXPECT_NEAR(p.normal.z, 1, 1e-12);
  }
  EXPECT_EQ(table.points.size(), static_cast<std::size_t>(table.columns * table.rows));
  const MeasuringGrid wall = gridOn(scene, "wall");
  for (const ProbePoint& p : wall.points) {
    EXPECT_NEAR(std::abs(p.normal.y), 1, 1e-12);
    EXPECT_NEAR(p.position.y, 3, 1e-12);
  }
}

TEST(MeasuringGrid, LiesOnTheUpperOfTwoDiscs) {
  Scene scene = tableAndWall();
  const std::size_t first = scene.primitives.size();
  for (const double z : {0.72, 0.75})
    scene.primitives.push_back({Ring{{1, 1, z}, {0, 0, z > 0.73 ? 1.0 : -1.0}, 0, 0.6}, MaterialId(0), ObjectId(0)});
  scene.objects.push_back({"round", ObjectId(0)});
  for (std::size_t i = first; i < scene.primitives.size(); ++i)
    scene.primitives[i].object = ObjectId(scene.objects.size() - 1);
  const MeasuringGrid grid = gridOn(scene, "round", {.border = 0, .spacing = 0.05});
  EXPECT_EQ(grid.columns, 24);
  EXPECT_NEAR(double(grid.points.size()) / (grid.columns * grid.rows), kPi / 4, 0.02);
  for (const ProbePoint& p : grid.points) {
    EXPECT_NEAR(p.position.z, 0.75, 1e-12);
    EXPECT_LT(glm::length(p.position - Vec3(1, 1, 0.75)), 0.6);
    EXPECT_NEAR(p.normal.z, 1, 1e-12);
  }
}

TEST(MeasuringGrid, HasPointsOnTheSurfaceAlone) {
  const Scene scene = tableAndWall();
  const MeasuringGrid floor = gridOn(scene, "floor");
  EXPECT_LT(floor.points.size(), static_cast<std::size_t>(floor.columns * floor.rows));
  EXPECT_EQ(floor.points.size(), floor.cells.size());
  for (const ProbePoint& p : floor.points) {
    EXPECT_NEAR(p.normal.z, 1, 1e-12);
    EXPECT_TRUE(p.position.y < 1.9 || p.position.x < 2) << p.position.x << " " << p.position.y;
  }
  EXPECT_TRUE(std::ranges::is_sorted(floor.cells));
}

TEST(MeasuringGrid, NamesWhatIsNotThere) {
  const Scene scene = tableAndWall();
  try {
    gridOn(scene, "tabel");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(error.hint().find("table"), std::string::npos) << error.hint();
  }
}

TEST(MeasuringGrid, TellsUniformity) {
  const std::vector<double> lux{300, 500, 450, 750};
  const GridStatistics s = statisticsOf(lux);
  EXPECT_DOUBLE_EQ(s.mean, 500);
  EXPECT_DOUBLE_EQ(s.uniformity(), 0.6);
  EXPECT_DOUBLE_EQ(s.diversity(), 0.4);
  EXPECT_EQ(statisticsOf(std::vector<double>{0.0, 0.0}).uniformity(), 0);
}

TEST(MeasuringGrid, ACylinderMeetsParallelLightByTheInverseOfPi) {
  const std::vector<ProbePoint> sides = cylinderAt({{1, 2, 3}, {0, 0, 1}}, {0, 0, 1});
  for (const double azimuth : {0.0, 0.1, 0.7, 2.0})
    for (const double height : {0.0, 0.5}) {
      const Vec3 to(std::cos(azimuth) * std::cos(height), std::sin(azimuth) * std::cos(height), std::sin(height));
      double sum = 0;
      for (const ProbePoint& side : sides) {
        EXPECT_NEAR(side.normal.z, 0, 1e-12);
        sum += std::max(0.0, glm::dot(side.normal, to));
      }
      EXPECT_NEAR(sum / static_cast<double>(sides.size()), std::cos(height) / kPi, 0.01 / kPi);
    }
}

}  // namespace
}  // namespace deltalux
