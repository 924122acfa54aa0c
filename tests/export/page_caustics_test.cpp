// The sheet of a group's caustic textures: every texture with its border, none over another.
#include <gtest/gtest.h>

#include "export/page_caustics.hpp"
#include "export/rgb9e5.hpp"

namespace deltalux {
namespace {

using namespace exporting;

CausticMesh texture(int width, int height, float value) {
  CausticMesh t;
  t.width = width, t.height = height;
  for (int i = 0; i < width * height; ++i) t.texels.emplace_back(value + float(i), 1, 2, i % 3 == 0 ? 0.0f : 1.0f);
  t.vertices = {{Vec3f(0), {0, 0}}, {Vec3f(1, 0, 0), {1, 0}}, {Vec3f(0, 1, 0), {0, 1}}};
  t.triangles = {0, 1, 2};
  return t;
}

TEST(PageCaustics, KeepsEveryTexelAndItsRims) {
  SolutionMesh mesh;
  auto surface = std::make_shared<SurfaceCausticMesh>();
  surface->textures = {texture(3, 2, 10), texture(5, 7, 100), texture(1, 1, 300)};
  mesh.caustics = {nullptr, surface};
  PageMesh page;
  page.sides = {{1, 0, 3, 4}};
  const auto sheet = pageCaustics(page, mesh);
  ASSERT_TRUE(sheet);
  ASSERT_EQ(sheet->positions.size(), 9u);
  EXPECT_EQ(sheet->triangles.size(), 9u);
  EXPECT_EQ(sheet->materials, std::vector<std::uint32_t>(9, 4));
  // Of each texture: where its first vertex has put its corner.
  std::vector<int> covered(sheet->texels.size(), 0);
  for (std::size_t v = 0; v < 9; v += 3) {
    const glm::vec2 size(sheet->width, sheet->height);
    const glm::ivec2 lower(glm::round(sheet->texcoords[v] * size));
    const glm::ivec2 upper(std::lround(sheet->texcoords[v + 1].x * size.x),
                           std::lround(sheet->texcoords[v + 2].y * size.y));
    const auto same = std::ranges::find_if(
        surface->textures, [&](const CausticMesh& t) { return glm::ivec2(t.width, t.height) == upper - lower; });
    ASSERT_NE(same, surface->textures.end());
    for (int y = -1; y <= same->height; ++y)
      for (int x = -1; x <= same->width; ++x) {
        const std::size_t at = std::size_t((lower.y + y) * sheet->width + lower.x + x);
        const int i = std::clamp(y, 0, same->height - 1) * same->width + std::clamp(x, 0, same->width - 1);
        EXPECT_EQ(sheet->texels[at], packRgb9e5(Rgb(same->texels[std::size_t(i)])));
        EXPECT_EQ(sheet->shows[at] > 127, same->texels[std::size_t(i)].a > 0.5f);
        EXPECT_EQ(covered[at]++, 0);
      }
  }
}

TEST(PageCaustics, NoTexturesAreNoSheet) { EXPECT_FALSE(pageCaustics(PageMesh{}, SolutionMesh{})); }

}  // namespace
}  // namespace deltalux
