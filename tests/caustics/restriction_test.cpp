#include "caustics/restriction.hpp"

#include <gtest/gtest.h>

#include "caustics/synthetic.hpp"

namespace deltalux {
using namespace caustics;

namespace {

std::vector<char> marks(const CellGrid& grid, const std::vector<glm::ivec2>& texels) {
  std::vector<char> marked(grid.size(), 0);
  for (const glm::ivec2& p : texels) marked[grid.cellOf(static_cast<std::size_t>(p.y) * grid.width() + p.x)] = 1;
  return marked;
}

TEST(Restriction, EveryPatchGetsItsBox) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 32, 32);
  const auto boxes = markedBoxes(grid, marks(grid, {{3, 4}, {4, 5}, {5, 5}, {20, 20}, {20, 21}}), 1);
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0], (TexelBox{2, 3, 7, 7}));
  EXPECT_EQ(boxes[1], (TexelBox{19, 19, 22, 23}));
}

TEST(Restriction, OverlappingBoxesBecomeOne) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 32, 32);
  EXPECT_EQ(markedBoxes(grid, marks(grid, {{3, 3}, {6, 3}}), 2), (std::vector<TexelBox>{{1, 1, 9, 6}}));
}

TEST(Restriction, FillsRunOnOverTheSeam) {
  const Shape cylinder = Cylinder{{0, 0, 0}, {0, 0, 1}, 0.2};
  const CellGrid grid = test::gridOver(cylinder, chartsOf(cylinder), 32, 16);
  const auto boxes = markedBoxes(grid, marks(grid, {{30, 8}, {31, 8}, {0, 8}, {1, 9}}), 0);
  ASSERT_EQ(boxes.size(), 1u);
  EXPECT_EQ(boxes[0], (TexelBox{30, 8, 34, 10}));
  EXPECT_TRUE(holds(boxes[0], 1, 8, 32));
  EXPECT_TRUE(holds(boxes[0], 31, 8, 32));
  EXPECT_FALSE(holds(boxes[0], 2, 8, 32));
}

TEST(Restriction, AFullTurnIsTheWholeWidth) {
  const Shape cylinder = Cylinder{{0, 0, 0}, {0, 0, 1}, 0.2};
  const CellGrid grid = test::gridOver(cylinder, chartsOf(cylinder), 8, 8);
  std::vector<glm::ivec2> row;
  for (int x = 0; x < 8; ++x) row.push_back({x, 3});
  EXPECT_EQ(markedBoxes(grid, marks(grid, row), 1), (std::vector<TexelBox>{{0, 2, 8, 5}}));
}

TEST(Restriction, OffTheMedianIsADifference) {
  const Shape square = test::unitSquare();
  const CellGrid grid = test::gridOver(square, chartsOf(square), 2, 2);
  const std::vector<Rgb> E{Rgb(1.0f), Rgb(1.0f), Rgb(1.3f), Rgb(100.0f)};
  EXPECT_EQ(cellsOffMedian(grid, grayOf(E), 0.2), (std::vector<char>{0, 0, 1, 1}));
}

TEST(Restriction, TheRegionsMatrixMapsItsBoxToTheUnitSquare) {
  const Region region{{1, 2}, {4, 8}};
  const glm::dmat3 m = region.toTexture();
  EXPECT_NEAR(glm::distance(m * Vec3(1, 2, 1), Vec3(0, 0, 1)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(m * Vec3(4, 8, 1), Vec3(1, 1, 1)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(m * Vec3(2.5, 3.5, 1), Vec3(0.5, 0.25, 1)), 0, 1e-12);
}

}  // namespace
}  // namespace deltalux
