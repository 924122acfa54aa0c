// Which surfaces of a solution get caustic textures.
#include <gtest/gtest.h>

#include <deltalux/io.hpp>

#include "base/parallel.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

Engine solvedScene(const char* file, double error) {
  SolveSettings settings;
  settings.error = error;
  Engine engine(loadScene({std::string(DELTALUX_SOURCE_DIR "/scenes/") + file}).scene, settings);
  engine.solve();
  return engine;
}

TEST(CausticTexturesOf, APurelyDiffuseSceneAreNone) {
  const Engine engine = solvedScene("cornell/cornell.rad", 0.05);
  EXPECT_EQ(engine.solution().report().counts.causticTextures, 0u);
  EXPECT_TRUE(engine.solution().caustics().empty());
}

TEST(CausticTexturesOf, TheRingAreOnTheTableAndHoldItsFlux) {
  const Engine engine = solvedScene("ring/ring.rad", 0.05);
  const Solution& s = engine.solution().get();
  ASSERT_NO_THROW(validate(s.caustics));
  const PrimitiveId table = primitivesOf(s.scene, findObjects(s.scene, "table").at(0)).at(0);
  const caustics::SurfaceCaustics* caustics = s.caustics.of(table, true);
  ASSERT_TRUE(caustics);
  RgbSum deposited(0.0);
  for (const particles::Impact& i : particles::impacts(s.particles, s.elements, s.scene))
    if (i.primitive == table && i.front) deposited += RgbSum(i.flux);
  EXPECT_NEAR(gray(caustics->flux()) / gray(deposited), 1.0, 1e-5);
  // The ring's surroundings alone need fine texels.
  const Vec2 size = caustics->textures.front().region.size();
  EXPECT_LT(size.x * size.y, 0.1 * area(s.scene[table].shape));
}

TEST(CausticTexturesOf, SolutionsAreTheSameForAnyNumberOfThreads) {
  const auto texels = [](std::size_t threads) {
    const ThreadLimit limit(threads);
    const Engine engine = solvedScene("ring/ring.rad", 0.1);
    std::vector<Rgb> all;
    for (const caustics::SurfaceCaustics& s : engine.solution().get().caustics.surfaces)
      for (const caustics::CausticTexture& t : s.textures) all.insert(all.end(), t.texels.begin(), t.texels.end());
    return all;
  };
  EXPECT_EQ(texels(1), texels(3));
}

}  // namespace
}  // namespace deltalux
