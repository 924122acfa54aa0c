// Light by groups of lamps: the columns add up to the plain solve, and dimming is their weighted sum.
#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/light_groups.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_file.hpp>

#include "hierarchy/leaf_table.hpp"
#include "support/furnished_room.hpp"
#include "support/solved.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using namespace test;

SolveSettings byLight() {
  SolveSettings settings = coarse();
  settings.byLight = true;
  return settings;
}

/// The furniture without its room, in the sun.
Scene furnitureInTheSun(bool sunIsOn) {
  Scene scene = furnishedRoom();
  applyEdit(scene, RemoveObject{"walls"});
  SunLight sun;
  sun.direction = glm::normalize(Vec3(0.3, -0.5, 0.8)), sun.radiance = Rgb(1e5f);
  scene.lights.push_back({"sun", sun, Rgb(sunIsOn ? 1.0f : 0.0f)});
  return scene;
}

Engine solvedBy(const SolveSettings& settings, Scene scene) {
  Engine engine(std::move(scene), settings);
  engine.solve();
  return engine;
}

/// Gray irradiance by leaf; of the same mesh.
std::vector<double> lightOfLeaves(const SolutionView& view) {
  const hierarchy::Elements& e = view.get().elements;
  std::vector<double> light;
  for (const hierarchy::ElementId leaf : hierarchy::LeafTable(e).leaves) {
    const hierarchy::ElementLight& l = e.radiometry[leaf.index()];
    light.push_back(gray(l.direct) + gray(l.indirect) + gray(l.particle));
  }
  return light;
}

/// The relative difference that so large a share of leaves does not exceed.
double differenceOf(const std::vector<double>& a, const std::vector<double>& b, double share) {
  EXPECT_EQ(a.size(), b.size());
  std::vector<double> differences;
  double mean = 0;
  for (const double value : b) mean += value / static_cast<double>(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences.push_back(std::abs(a[i] - b[i]) / std::max(b[i], 1e-3 * mean));
  std::ranges::sort(differences);
  return differences[static_cast<std::size_t>(share * static_cast<double>(differences.size() - 1))];
}

void scale(Engine& engine, const char* light, float by) { engine.apply(ScaleLight{light, by}); }

TEST(LightColumns, AddUpToThePlainSolve) {
  const Engine plain = solvedBy(coarse(), furnishedRoom()), apart = solvedBy(byLight(), furnishedRoom());
  EXPECT_EQ(hashOf(plain), hashOf(apart));
  const std::vector<LightGroup> groups = lightGroups(apart.solution());
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].name, "globe");
  EXPECT_EQ(groups[1].name, "spot");
  std::vector<double> sum(lightOfLeaves(plain.solution()).size(), 0.0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::vector<double> one = lightOfLeaves(lightOf(apart.solution(), g));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += one[i];
  }
  EXPECT_LT(differenceOf(sum, lightOfLeaves(plain.solution()), 0.95), 1e-4);
  EXPECT_LT(differenceOf(lightOfLeaves(apart.solution()), sum, 1.0), 1e-5);
}

TEST(LightColumns, AreMeasuredTogetherAsOneByOne) {
  const Engine apart = solvedBy(byLight(), furnishedRoom());
  const std::vector<ProbePoint> points{{{1, 1, 0}, {0, 0, 1}}, {{2, 1.5, 0}, {0, 0, 1}}, {{1.5, 1, 1.2}, {1, 0, 0}}};
  const auto together = probeByLight(apart.solution(), points);
  ASSERT_EQ(together.size(), 2u);
  double most = 0;
  for (std::size_t g = 0; g < together.size(); ++g) {
    const std::vector<ProbeResult> alone = probe(lightOf(apart.solution(), g), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      EXPECT_EQ(together[g][i].irradiance, alone[i].irradiance) << g << " " << i;
      most = std::max(most, together[g][i].irradiance.g);
    }
  }
  EXPECT_GT(most, 0);
}

TEST(LightColumns, DimmedTheyAreTheFreshSolveOfTheDimmedScene) {
  Engine apart = solvedBy(byLight(), furnishedRoom());
  scale(apart, "globe", 0.3f);
  apart.apply(ColourLight{"spot", Rgb(0.9f, 0.4f, 0.1f)});
  const StepReport step = apart.update();
  EXPECT_EQ(step.rays, 0u);
  const Engine fresh = solvedBy(coarse(), apart.solution().scene());
  EXPECT_EQ(hashOf(apart), hashOf(fresh));
  EXPECT_LT(differenceOf(lightOfLeaves(apart.solution()), lightOfLeaves(fresh.solution()), 0.95), 1e-3);
}

TEST(LightColumns, DimmingThereAndBackIsExact) {
  Engine apart = solvedBy(byLight(), furnishedRoom());
  const std::vector<double> before = lightOfLeaves(apart.solution());
  apart.apply(SwitchLight{"globe", false});
  apart.update();
  EXPECT_GT(differenceOf(lightOfLeaves(apart.solution()), before, 0.5), 0.1);
  apart.apply(SwitchLight{"globe", true});
  apart.update();
  EXPECT_EQ(differenceOf(lightOfLeaves(apart.solution()), before, 1.0), 0);
}

TEST(LightColumns, ASunThatWasOffComesOnWithoutARay) {
  Engine apart = solvedBy(byLight(), furnitureInTheSun(false));
  apart.apply(ColourLight{"sun", Rgb(1.0f)});
  const StepReport step = apart.update();
  EXPECT_EQ(step.rays, 0u);
  const Engine fresh = solvedBy(byLight(), furnitureInTheSun(true));
  EXPECT_EQ(hashOf(apart), hashOf(fresh));
  EXPECT_LT(differenceOf(lightOfLeaves(apart.solution()), lightOfLeaves(fresh.solution()), 1.0), 1e-5);
}

TEST(LightColumns, FollowMovesAndPaint) {
  Engine apart = solvedBy(byLight(), furnishedRoom());
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(0.2, 0.1, 0, 1);
  apart.apply(TransformObject{"box", matrix});
  apart.apply(SetMaterial{"white", Rgb(0.5f), {}});
  apart.update();
  const Engine fresh = solvedBy(byLight(), apart.solution().scene());
  for (std::size_t g = 0; g < 2; ++g)
    EXPECT_LT(
        differenceOf(lightOfLeaves(lightOf(apart.solution(), g)), lightOfLeaves(lightOf(fresh.solution(), g)), 1.0),
        1e-4);
}

TEST(LightColumns, PatternsMakeGroups) {
  SolveSettings settings = byLight();
  settings.groups = {{"all lamps", "*o*"}};
  const Engine apart = solvedBy(settings, furnitureInTheSun(true));
  const std::vector<LightGroup> groups = lightGroups(apart.solution());
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].name, "all lamps");
  EXPECT_EQ(groups[0].lights.size(), 2u);
  EXPECT_EQ(groups[1].name, "sun");
}

TEST(LightColumns, ALampOfAGroupDimmedByItselfIsIteratedFor) {
  SolveSettings settings = byLight();
  settings.groups = {{"lamps", "globe"}, {"lamps", "spot"}};
  Engine apart = solvedBy(settings, furnishedRoom());
  scale(apart, "spot", 0.2f);
  apart.update();
  const Engine fresh = solvedBy(coarse(), apart.solution().scene());
  EXPECT_LT(differenceOf(lightOfLeaves(apart.solution()), lightOfLeaves(fresh.solution()), 0.95), 1e-3);
}

TEST(LightColumns, AFileKeepsThemAndCanBeDimmed) {
  const TempFolder folder;
  Engine apart = solvedBy(byLight(), furnishedRoom());
  saveSolution(folder / "room.dlx", apart.solution());
  Engine read(loadSolution(folder / "room.dlx"));
  EXPECT_EQ(lightGroups(read.solution()), lightGroups(apart.solution()));
  for (Engine* engine : {&apart, &read}) scale(*engine, "globe", 0.5f), engine->update();
  EXPECT_LT(differenceOf(lightOfLeaves(read.solution()), lightOfLeaves(apart.solution()), 1.0), 1e-6);
}

}  // namespace
}  // namespace deltalux
