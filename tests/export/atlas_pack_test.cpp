#include "export/atlas_pack.hpp"

#include <gtest/gtest.h>

#include <random>

namespace deltalux::exporting {
namespace {

/// How many rectangles lie on each texel of a page, and none beyond its size.
void expectNoOverlaps(const std::vector<glm::ivec2>& sizes, const Packing& packing) {
  std::vector<std::vector<int>> used;
  for (const glm::ivec2& page : packing.pages) used.emplace_back(static_cast<std::size_t>(page.x * page.y), 0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const PackedRect& r = packing.at[i];
    const glm::ivec2 page = packing.pages[r.page];
    ASSERT_TRUE(r.corner.x >= 0 && r.corner.y >= 0);
    ASSERT_TRUE(r.corner.x + sizes[i].x <= page.x && r.corner.y + sizes[i].y <= page.y);
    for (int y = r.corner.y; y < r.corner.y + sizes[i].y; ++y)
      for (int x = r.corner.x; x < r.corner.x + sizes[i].x; ++x)
        ASSERT_EQ(used[r.page][static_cast<std::size_t>(y * page.x + x)]++, 0);
  }
}

std::vector<glm::ivec2> randomSizes(int count, int most) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> side(1, most);
  std::vector<glm::ivec2> sizes;
  for (int i = 0; i < count; ++i) sizes.emplace_back(side(random), side(random));
  return sizes;
}

TEST(AtlasPack, RectanglesDoNotOverlap) {
  const std::vector<glm::ivec2> sizes = randomSizes(300, 40);
  expectNoOverlaps(sizes, packRects(sizes, 256));
}

TEST(AtlasPack, LeavesLittleEmpty) {
  const std::vector<glm::ivec2> sizes = randomSizes(500, 40);
  const Packing packing = packRects(sizes, 1024);
  ASSERT_EQ(packing.pages.size(), 1u);
  double area = 0;
  for (const glm::ivec2& s : sizes) area += s.x * s.y;
  EXPECT_GT(area, 0.8 * packing.pages[0].x * packing.pages[0].y);
}

TEST(AtlasPack, FillsAPageExactlyAndGoesOnToTheNext) {
  const std::vector<glm::ivec2> sizes(5, glm::ivec2(32));
  const Packing packing = packRects(sizes, 64);
  ASSERT_EQ(packing.pages.size(), 2u);
  EXPECT_EQ(packing.pages[0], glm::ivec2(64));
  EXPECT_EQ(packing.pages[1], glm::ivec2(32));
  expectNoOverlaps(sizes, packing);
}

TEST(AtlasPack, OfNothingIsNothing) { EXPECT_TRUE(packRects({}, 64).pages.empty()); }

}  // namespace
}  // namespace deltalux::exporting
