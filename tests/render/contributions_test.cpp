#include <gtest/gtest.h>

#include <deltalux/contributions.hpp>
#include <deltalux/solution_reader.hpp>

#include "support/solved.hpp"

namespace deltalux {
namespace {

/// A closed room with two lamps of 3 : 1 as far from the middle of its floor, and one behind a screen.
Scene twoLamps(float scale) {
  Scene scene;
  test::addBox(scene, test::addMaterial(scene, "wall", test::lambert(0.5f)), {0, 0, 0}, {4, 4, 3}, true);
  const ObjectId walls = internObject(scene, "walls", '.');
  for (Primitive& p : scene.primitives) p.object = walls;
  const MaterialId black = test::addMaterial(scene, "black", test::lambert(0.0f));
  test::addBox(scene, black, {2.9, 0.5, 0.0}, {3.0, 3.5, 2.9}, false);
  test::addLight(scene, PointLight{{1.0, 2.0, 2.5}, Rgb(3.0f * scale)});
  test::addLight(scene, PointLight{{2.0, 1.0, 2.5}, Rgb(1.0f * scale)});
  test::addLight(scene, PointLight{{3.8, 2.0, 1.0}, Rgb(9.0f * scale)});
  for (std::size_t l = 0; l < scene.lights.size(); ++l) scene.lights[l].name = "lamp" + std::to_string(l);
  return scene;
}
const ProbePoint kMiddle{{2.0, 2.0, 0.0}, {0, 0, 1}};

TEST(Contributions, TellLampsApart) {
  const Engine engine = test::solved(twoLamps(1), 0.1);
  const SolutionReader reader(engine.solution());
  const Contributions c = reader.contributions(kMiddle);
  ASSERT_TRUE(c.onSurface);
  ASSERT_EQ(c.lamps.size(), 2u) << "the third is hidden";
  EXPECT_EQ(c.lamps[0].light, LightId(0));
  EXPECT_EQ(c.lamps[1].light, LightId(1));
  EXPECT_NEAR(gray(c.lamps[0].E) / gray(c.lamps[1].E), 3, 0.15);
  // E = I h / d^3.
  EXPECT_NEAR(gray(c.lamps[1].E), 2.5 / std::pow(1 + 2.5 * 2.5, 1.5), 0.002);
  EXPECT_NEAR(gray(c.direct), gray(c.lamps[0].E + c.lamps[1].E), 1e-9);
}

TEST(Contributions, SumUpToWhatIsMeasured) {
  const Engine engine = test::solved(twoLamps(1), 0.1);
  const SolutionReader reader(engine.solution());
  ContributionSettings settings;
  settings.error = 0.01, settings.most = 1;
  const Contributions c = reader.contributions(kMiddle, settings);
  const ProbeResult probed = reader.probe(std::vector{kMiddle}).front();
  EXPECT_NEAR(gray(c.direct + c.indirect + c.particle), gray(probed.irradiance), 0.02 * gray(probed.irradiance));
  EXPECT_GT(gray(c.indirect), 0.1 * gray(c.direct));
  ASSERT_EQ(c.surfaces.size(), 1u);
  EXPECT_NEAR(gray(c.surfaces[0].E), gray(c.indirect), 1e-6 * gray(c.indirect)) << "all else is black";
  EXPECT_EQ(engine.solution().scene()[c.surfaces[0].object].name, "walls");
  EXPECT_GT(c.surfaces[0].centre.z, 0.2);
  EXPECT_TRUE(c.paths.empty());
  EXPECT_EQ(c.particle, glm::dvec3(0));
}

TEST(Contributions, AreLinearInTheLight) {
  const Engine one = test::solved(twoLamps(1), 0.1), ten = test::solved(twoLamps(10), 0.1);
  const Contributions a = SolutionReader(one.solution()).contributions(kMiddle),
                      b = SolutionReader(ten.solution()).contributions(kMiddle);
  EXPECT_NEAR(gray(b.direct), 10 * gray(a.direct), 0.01 * gray(b.direct));
  EXPECT_NEAR(gray(b.indirect), 10 * gray(a.indirect), 0.02 * gray(b.indirect));
}

TEST(Contributions, OfSpaceAreNone) {
  const Engine engine = test::solved(twoLamps(1), 0.3);
  const Contributions c = SolutionReader(engine.solution()).contributions({{2, 2, 1.5}, {0, 0, 1}});
  EXPECT_FALSE(c.onSurface);
  EXPECT_TRUE(c.lamps.empty() && c.surfaces.empty() && c.paths.empty());
}

/// The sun by way of a mirror on the ground to a wall: z in [1,2], y in [0,1].
TEST(Contributions, ListThePathOverAMirror) {
  Scene scene;
  test::addPolygon(scene, test::addMaterial(scene, "wall", test::lambert(0.5f)),
                   {{-1, -1, 0}, {-1, 3, 0}, {-1, 3, 3}, {-1, -1, 3}});
  test::addPolygon(scene, test::addMaterial(scene, "mirror", Mirror{Rgb(0.9f)}),
                   {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  SunLight sun;
  sun.direction = glm::normalize(Vec3(1, 0, 1)), sun.angularRadius = 0.001;
  sun.radiance = Rgb(static_cast<float>(std::sqrt(2.0) / solidAngle(sun)));
  test::addLight(scene, sun);
  SolveSettings settings;
  settings.particles = 40000;
  Engine engine(std::move(scene), settings);
  engine.solve();
  const SolutionReader reader(engine.solution());
  const Vec3 at(-1, 0.5, 1.5);
  const Contributions c = reader.contributions({at, {1, 0, 0}});
  EXPECT_NEAR(gray(c.particle), 0.9, 0.1);
  ASSERT_EQ(c.paths.size(), 1u);
  const Contributions::Path& path = c.paths[0];
  EXPECT_NEAR(gray(path.E), gray(c.particle), 1e-6);
  EXPECT_GT(path.particles, 50u);
  ASSERT_EQ(path.corners.size(), 3u);
  EXPECT_LT(glm::length(path.corners[1] - Vec3(0.5, 0.5, 0)), 0.2) << "where the mirror shows the sun";
  EXPECT_LT(glm::length(path.corners[2] - at), 1e-5);
  const Contributions dark = reader.contributions({{-1, 2.5, 1.5}, {1, 0, 0}});
  EXPECT_LT(gray(dark.particle), 0.03);
}

}  // namespace
}  // namespace deltalux
