// Charts on pages: apart by their gutters, inside the page, as dense as asked for.
#include "export/atlas_layout.hpp"

#include <gtest/gtest.h>

#include "baked_scene.hpp"

namespace deltalux::exporting {
namespace {

/// Every texel of a page belongs to one chart and its gutter at most.
void expectApart(const Atlas& atlas) {
  std::vector<std::vector<char>> used;
  for (const glm::ivec2& page : atlas.pages) used.emplace_back(static_cast<std::size_t>(page.x * page.y), 0);
  for (const ChartPlace& p : atlas.places) {
    const glm::ivec2 low = p.first - atlas.gutter, high = p.first + p.texels + atlas.gutter, page = atlas.pages[p.page];
    ASSERT_TRUE(low.x >= 0 && low.y >= 0 && high.x <= page.x && high.y <= page.y);
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) ASSERT_EQ(used[p.page][static_cast<std::size_t>(y * page.x + x)]++, 0);
  }
}

Atlas everythingLaidOut(const AtlasSettings& settings) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  return layOut(litCharts(mesh, test::kCrease), settings, 0);
}

TEST(AtlasLayout, FillsOnePageByItself) {
  AtlasSettings settings;
  settings.side = 512;
  const Atlas atlas = everythingLaidOut(settings);
  ASSERT_EQ(atlas.pages.size(), 1u);
  EXPECT_LE(std::max(atlas.pages[0].x, atlas.pages[0].y), 512);
  EXPECT_GT(atlas.pages[0].x * atlas.pages[0].y, 512 * 512 / 2);
  expectApart(atlas);
}

TEST(AtlasLayout, TakesTheDensityAskedForAndAsManyPagesAsItNeeds) {
  AtlasSettings settings;
  settings.side = 128, settings.gutter = 3, settings.texelsPerUnit = 50;
  const Atlas atlas = everythingLaidOut(settings);
  EXPECT_GT(atlas.pages.size(), 1u);
  expectApart(atlas);
  for (std::size_t i = 0; i < atlas.charts.size(); ++i)
    for (int axis = 0; axis < 2; ++axis) {
      const int fits = settings.side - 2 * settings.gutter;
      EXPECT_GE(atlas.places[i].texels[axis] - 1 + 1e-6, std::min(50 * atlas.charts[i].size[axis], fits - 1.0));
    }
}

TEST(AtlasLayout, IsNoFinerThanShowsSomething) {
  const SolutionMesh mesh = test::meshOf(test::everythingSolved());
  const Atlas atlas = layOut(litCharts(mesh, test::kCrease), {}, 0.1);
  EXPECT_NEAR(atlas.texelsPerUnit, 10, 1e-9);
}

TEST(AtlasLayout, PutsBordersOnTexelCentres) {
  AtlasChart chart;
  chart.size = Vec2(2, 1);
  const Atlas atlas = layOut({chart}, {10, 64, 2}, 0);
  EXPECT_EQ(atlas.places[0].texels, glm::ivec2(21, 11));
  EXPECT_EQ(atlas.pages[0], glm::ivec2(25, 15));
  EXPECT_NEAR(glm::length(texcoordOf(atlas, 0, Vec2(0)) * Vec2(25, 15) - Vec2(2.5)), 0, 1e-12);
  EXPECT_NEAR(glm::length(texcoordOf(atlas, 0, chart.size) * Vec2(25, 15) - Vec2(22.5, 12.5)), 0, 1e-12);
}

TEST(AtlasLayout, OfNothingHasNoPages) { EXPECT_TRUE(layOut({}, {}, 0).pages.empty()); }

}  // namespace
}  // namespace deltalux::exporting
