#include <gtest/gtest.h>

#include "export/page_lights.hpp"
#include "export/page_sky.hpp"
#include "support/solution_scenes.hpp"

namespace deltalux {
namespace {

using namespace exporting;

std::vector<LightGroup> oneEach(const Scene& scene) {
  std::vector<LightGroup> groups;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) groups.push_back({"light" + std::to_string(i), {LightId(i)}});
  return groups;
}

TEST(PageLights, KnowTheirKindColourAndScale) {
  Scene scene;
  const MaterialId glow = test::addMaterial(scene, "glow", test::lambert(0), Emission{Rgb(20, 10, 5), false, {}, {}});
  test::addPolygon(scene, glow, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  addAreaLights(scene);
  test::addLight(scene, SunLight{{0, 0, 1}, 0.005, Rgb(9, 8, 7)});
  test::addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(0.2f, 0.3f, 0.4f), UniformSky{2}, {0, 0, 1}});
  scene.lights[0].scale = Rgb(0.5f, 0.25f, 0.25f);
  const std::vector<PageGroup> groups = pageGroups(scene, oneEach(scene), false);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].kind, PageGroup::Kind::Lamp);
  EXPECT_EQ(groups[0].weight, Rgb(0.5f, 0.25f, 0.25f));
  EXPECT_EQ(groups[0].lights[0].base, Rgb(1.0f));
  EXPECT_NEAR(groups[0].colour.g, 0.5, 1e-6);
  EXPECT_EQ(groups[1].kind, PageGroup::Kind::Sun);
  EXPECT_EQ(groups[2].kind, PageGroup::Kind::Sky);
  EXPECT_NEAR(groups[2].colour.r, 0.5, 1e-6);
}

TEST(PageLights, NotSolvedByLightStartAtThePresentState) {
  Scene scene;
  test::addLight(scene, PointLight{{0, 0, 1}, Rgb(1.0f)});
  test::addLight(scene, PointLight{{0, 0, 2}, Rgb(1.0f)});
  scene.lights[0].name = "a", scene.lights[1].name = "b";
  scene.lights[1].scale = Rgb(0.0f), scene.switchedOff = {{LightId(1), Rgb(1.0f)}};
  scene.lights[0].scale = Rgb(0.3f);
  const std::vector<PageGroup> groups = pageGroups(scene, {{"all", {LightId(0), LightId(1)}}}, true);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].weight, Rgb(1.0f));
  ASSERT_EQ(groups[0].lights.size(), 2u);
  EXPECT_EQ(groups[0].lights[0].base, Rgb(0.3f));
  EXPECT_FALSE(groups[0].lights[0].switchedOff);
  EXPECT_TRUE(groups[0].lights[1].switchedOff);
}

TEST(PageSky, IsWhatSkiesSend) {
  const Scene scene = test::oneOfEverything();
  const std::vector<LightGroup> groups = oneEach(scene);
  const std::vector<PageSky> skies = pageSkies(scene, groups, true);
  Rgb sum(0.0f), expected(0.0f);
  const int x = 17, y = 20;
  const double azimuth = 2 * kPi * ((x + 0.5) / kSkyWidth - 0.5), polar = kPi * (y + 0.5) / kSkyHeight;
  const Vec3 w(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
  for (const PageSky& sky : skies) sum += sky.radiance[std::size_t(y * kSkyWidth + x)];
  for (const Light& light : scene.lights)
    if (const auto* dome = std::get_if<DomeLight>(&light.emitter)) expected += light.scale * skyRadiance(*dome, w);
  EXPECT_GT(gray(sum), 0);
  EXPECT_NEAR(gray(sum), gray(expected), 1e-5 * gray(expected));
  EXPECT_EQ(pageSuns(scene, groups, true).size(), 1u);
}

}  // namespace
}  // namespace deltalux
