// Solves over links.
#include "paper/solve.hpp"

#include <gtest/gtest.h>

#include <deltalux/io.hpp>
#include <deltalux/solution_file.hpp>

#include "base/parallel.hpp"
#include "support/furnished_room.hpp"
#include "support/residue.hpp"
#include "support/run_cli.hpp"
#include "support/solved.hpp"
#include "support/temp_folder.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

Scene cornellBox() { return loadScene({test::bundledScene("cornell/cornell.rad")}).scene; }

/// What arrives, by primitive [W, gray].
std::vector<double> arriving(const Engine& engine) {
  const Solution& s = engine.solution().get();
  std::vector<double> power(s.scene.primitives.size(), 0.0);
  for (std::size_t i = 0; i < s.elements.size(); ++i) {
    if (!s.elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    const hierarchy::ElementLight& l = s.elements.radiometry[i];
    power[s.elements.domain[i].primitive.index()] +=
        s.elements.geometry[i].litArea() * gray(l.direct + l.indirect + l.particle);
  }
  return power;
}

TEST(PaperSolve, BringsWhatLinesBring) {
  const std::vector<double> a = arriving(test::solved(cornellBox(), 0.005, SolveMethod::Paper)),
                            b = arriving(test::solved(cornellBox(), 0.02, SolveMethod::Lines));
  double all = 0, byLines = 0;
  for (std::size_t i = 0; i < a.size(); ++i) all += a[i], byLines += b[i];
  EXPECT_NEAR(all / byLines, 1, 0.05);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (b[i] > 0.05 * byLines) {
      EXPECT_NEAR(a[i] / b[i], 1, 0.05) << i;
    }
}

TEST(PaperSolve, LosesLittleEnergy) {
  const Engine box = test::solved(cornellBox(), 0.05, SolveMethod::Paper);
  EXPECT_TRUE(box.solution().report().converged);
  EXPECT_NEAR(test::residue(box.solution().report().energy), 0, 0.025);
  const Engine finer = test::solved(cornellBox(), 0.01, SolveMethod::Paper);
  EXPECT_LT(std::abs(test::residue(finer.solution().report().energy)),
            std::abs(test::residue(box.solution().report().energy)));
}

TEST(PaperSolve, LightsAWellOnAFloorThatIsMuchLarger) {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.8f));
  const MaterialId dark = test::addMaterial(scene, "dark", test::lambert(0.05f));
  test::addPolygon(scene, white, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}});
  test::addShape(scene, dark, Cylinder{{0.3, 0.2, 0}, {0.3, 0.2, 0.08}, 0.1, true});  // seen from inside
  test::addShape(scene, dark, Cylinder{{0.3, 0.2, 0}, {0.3, 0.2, 0.08}, 0.104, false});
  SpotLight spot;
  spot.position = {0.3, 0.2, 2}, spot.direction = {0, 0, -1};
  spot.cosInner = 0.9, spot.cosOuter = 0.7, spot.intensity = Rgb(4.0f);
  test::addLight(scene, spot);
  // Of the floor in the well, which all of the spot reaches, and of the wall itself; some 0.0166 W in all.
  const double links = arriving(test::solved(scene, 0.1, SolveMethod::Paper))[1],
               lines = arriving(test::solved(scene, 0.01, SolveMethod::Lines))[1];
  EXPECT_NEAR(links / lines, 1, 0.2);
}

TEST(PaperSolve, SolvesAFurnishedRoom) {
  const Engine engine = test::solved(test::furnishedRoom(), 0.1, SolveMethod::Paper);
  test::expectValid(engine, "solve");
  const SolveReport& report = engine.solution().report();
  EXPECT_TRUE(report.converged);
  EXPECT_GT(report.counts.links, report.counts.leafElements);
  EXPECT_GT(report.counts.particles, 0u);
  EXPECT_NEAR(test::residue(report.energy), 0, 0.03);
}

TEST(PaperSolve, DoesNotDependOnTheThreadCount) {
  const auto solve = [](std::size_t threads) {
    const ThreadLimit limit(threads);
    return arriving(test::solved(cornellBox(), 0.1, SolveMethod::Paper));
  };
  const std::vector<double> one = solve(1);
  EXPECT_EQ(one, solve(2));
  EXPECT_EQ(one, solve(4));
}

TEST(PaperSolve, WhatNoLightReachesHasNoElement) {
  Scene scene;
  const MaterialId white = test::addMaterial(scene, "white", test::lambert(0.6f));
  const MaterialId lamp = test::addMaterial(scene, "lamp", test::lambert(0.0f), Emission{Rgb(10.0f), false, {}});
  test::addBox(scene, white, {0, 0, 0}, {4, 3, 2.5}, true);
  test::addBox(scene, white, {1.5, 1, 0}, {2.2, 1.8, 1.1}, false);
  const std::size_t walls = scene.primitives.size();
  test::addPolygon(scene, lamp, {{1, 1, 2.4}, {1, 1.6, 2.4}, {1.6, 1.6, 2.4}, {1.6, 1, 2.4}});
  const Engine engine = test::solved(std::move(scene), 0.05, SolveMethod::Paper);
  const hierarchy::Elements& e = engine.solution().get().elements;
  for (std::size_t i = 0; i < e.size(); ++i)
    if (e.isInputLevel(hierarchy::ElementId(i)) && e.domain[i].primitive.index() < walls) {
      EXPECT_TRUE(e.topology[i].front) << e.domain[i].primitive.index();
    }
}

TEST(PaperSolve, RoundsEndAtTheirLeastError) {
  const double least = paper::oracleSettingsFor(0.05).error;
  double error = 64 * least;
  int rounds = 0;
  for (; error > least; ++rounds) error = paper::nextError(error, least);
  EXPECT_EQ(error, least);
  EXPECT_LT(rounds, 8);
  EXPECT_LT(paper::oracleSettingsFor(0.01).error, least);
}

TEST(PaperSolve, EndsInTime) {
  SolveSettings settings;
  settings.error = 0.001, settings.seconds = 1, settings.method = SolveMethod::Paper;
  Engine engine(test::furnishedRoom(), settings);
  const SolveReport report = engine.solve();
  EXPECT_LT(report.times.total, 4);
  EXPECT_FALSE(report.converged);
  test::expectValid(engine, "solve");
}

TEST(PaperSolve, GoesOnFromAFile) {
  const test::TempFolder folder;
  Engine engine = test::solved(cornellBox(), 0.1, SolveMethod::Paper);
  saveSolution(folder / "box.dlx", engine.solution());
  Engine again(loadSolution(folder / "box.dlx"));
  const Edit edit = ScaleLight{"lamp", 0.5f};
  engine.apply(edit), again.apply(edit);
  engine.update(), again.update();
  EXPECT_EQ(arriving(engine), arriving(again));
}

}  // namespace
}  // namespace deltalux
