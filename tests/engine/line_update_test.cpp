// An update over lines is a fresh solve of the edited scene, bit for bit in mesh, lines and particles.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <memory>

#include "support/furnished_room.hpp"
#include "support/rooms.hpp"
#include "support/shared.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

using namespace test;

TEST(LineUpdate, IsTheFreshSolveAfterEachOfManyEdits) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 11);
  for (int i = 0; i < 8; ++i) {
    edits.step();
    ASSERT_TRUE(isTheFreshOne(engine)) << i << ": " << edits.last();
    expectValid(engine, edits.last());
  }
  edits.undoAll();
  expectValid(engine, "undo");
  EXPECT_TRUE(isTheFreshOne(engine));
}

TEST(LineUpdate, HasTheRowsOfTheFreshSolve) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 17);
  for (int i = 0; i < 6; ++i) {
    edits.step();
    Engine fresh(engine.solution().scene(), coarse());
    fresh.solve();
    lines::Exchange a = *engine.solution().get().memory->exchange, b = *fresh.solution().get().memory->exchange;
    ASSERT_EQ(a.leaves(), b.leaves());
    std::vector<Rgb> B(a.leaves()), Ea(a.leaves()), Eb(a.leaves());
    for (std::size_t k = 0; k < B.size(); ++k) B[k] = Rgb(toUnitFloat(mix64(k)));
    a.gather(B, Ea), b.gather(B, Eb);
    for (std::size_t k = 0; k < B.size(); ++k)
      ASSERT_NEAR(Ea[k].g, Eb[k].g, 5 * lines::kFollowed * Eb[k].g) << edits.last() << ' ' << k;
  }
}

/// Random edits of everything in a small room of tests/assets/dark, held against fresh solves every so many.
struct DarkSession {
  const char* room;
  std::uint64_t seed;
  int edits, every;
};

class LineUpdateInTheDark : public testing::TestWithParam<DarkSession> {};

TEST_P(LineUpdateInTheDark, IsTheFreshSolveWhateverIsEdited) {
  const DarkSession& session = GetParam();
  SolveSettings settings;
  settings.error = 0.1;
  Engine engine(loadScene({sourceFolder() / "tests/assets/dark" / (std::string(session.room) + ".rad")}).scene,
                settings);
  engine.solve();
  RandomEdits edits(engine, everythingIn(engine.solution().scene()), session.seed);
  for (int i = 1; i <= session.edits; ++i) {
    edits.step();
    if (i % session.every == 0) {
      ASSERT_TRUE(isTheFreshOne(engine)) << edits.last();
    }
  }
}

// Skies that go and come back; lines behind a sheet that sends them on as they came; lamps behind slots.
INSTANTIATE_TEST_SUITE_P(Each, LineUpdateInTheDark,
                         testing::Values(DarkSession{"opal-rooflight", 1, 36, 4},
                                         DarkSession{"opal-rooflight", 4, 12, 2},
                                         DarkSession{"shutter-slot", 1, 40, 4}),
                         [](const testing::TestParamInfo<DarkSession>& of) {
                           return "Session" + std::to_string(of.index);
                         });

/// A patch may be asked because light varies over it in one update, because particles split what it is part of in the
/// next, and not at all in one between.
TEST(LineUpdate, KnowsOfNoPatchWhatIsOfAnotherTime) {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000, settings.causticTextures = false;
  Engine engine(furnishedRoom(), settings);
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 1);
  for (int i = 0; i < 11; ++i) {
    edits.step();
    if (i <= 7) continue;
    EXPECT_TRUE(isTheFreshOne(engine)) << edits.last();
  }
}

TEST(LineUpdate, WithoutParticlesToo) {
  SolveSettings settings = coarse();
  settings.diffuseOnly = true;
  Engine engine(furnishedRoom(), settings);
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 23);
  for (int i = 0; i < 8; ++i) edits.step();
  EXPECT_TRUE(isTheFreshOne(engine));
}

TEST(LineUpdate, LeavesTheSceneDarkWhenItsOnlyLampIsGone) {
  for (const SolveMethod method : {SolveMethod::Lines, SolveMethod::Paper}) {
    SolveSettings settings = coarse();
    settings.method = method;
    Engine engine(loadScene({sourceFolder() / "scenes/cornell-caustic/cornell-caustic.rad"}).scene, settings);
    engine.solve();
    const Restore back = engine.apply(RemoveObject{"lamp"});
    engine.update();
    const Solution& s = engine.solution().get();
    for (std::size_t i = 0; i < s.elements.size(); ++i)
      if (s.elements.isReceivingLeaf(hierarchy::ElementId(i))) {
        const hierarchy::ElementLight& l = s.elements.radiometry[i];
        ASSERT_NEAR(gray(l.direct + l.indirect + l.particle), 0, 1e-4);
      }
    engine.apply(back);
    engine.update();
    EXPECT_GT(gray(s.elements.radiometry[s.elements.sceneRoot.index()].direct), 0.1);
    if (method == SolveMethod::Lines) {
      EXPECT_TRUE(isTheFreshOne(engine));
    }
  }
}

TEST(LineUpdate, AnUnknownNameLeavesEverythingAsItWas) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  const std::uint64_t before = hashOf(engine);
  EXPECT_THROW(engine.apply(RemoveObject{"boks"}), InputError);
  engine.update();
  EXPECT_EQ(hashOf(engine), before);
}

TEST(LineUpdate, AsksOnlyWhatAMotionMayHaveChanged) {
  Engine engine(furnishedRoom(), coarse());
  engine.solve();
  const std::string object = editableOfFurnishedRoom().objects.front();
  for (const double step : {0.05, -0.03}) {
    engine.apply(TransformObject{object, glm::translate(Mat4(1), Vec3(step, 0, 0))});
    engine.update();
    const std::uint64_t rays = engine.solution().get().report.counts.raysVisibility;
    Engine fresh(engine.solution().scene(), coarse());
    EXPECT_LT(static_cast<double>(rays), 0.7 * static_cast<double>(fresh.solve().counts.raysVisibility));
    EXPECT_EQ(hashOf(engine), hashOf(fresh)) << step;
  }
}

TEST(LineUpdate, KnowsTheRestWhenTheRimOfTheSceneMoves) {
  // A room with a window on a meadow, and a crate farther out than all else.
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.6f));
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  scene.primitives.erase(scene.primitives.begin());  // a wall
  addBox(scene, white, {1, 1, 0.5}, {2, 2, 0.7}, false);
  addLight(scene, PointLight{{2, 1.5, 2.3}, Rgb(5.0f)});
  addLight(scene, DomeLight{{0, 0, 1}, kPi / 2, Rgb(3.0f), UniformSky{1.0}, {0, 0, 1}});
  addBlock(scene, "crate", white, {14, 1, 0}, {15, 2, 1});
  Engine engine(std::move(scene), coarse());
  const std::uint64_t leaves = engine.solve().counts.leafElements;
  for (const double step : {0.6, -1.3, 0.1}) {
    engine.apply(TransformObject{"crate", glm::translate(Mat4(1), Vec3(step, 0, 0))});
    EXPECT_LT(engine.update().leavesChanged, leaves / 4) << step;
    EXPECT_TRUE(isTheFreshOne(engine)) << step;
    expectValid(engine, "crate");
  }
}

TEST(LineUpdate, KnowsASolveThatHadTimeEnough) {
  const Edit edit =
      TransformObject{editableOfFurnishedRoom().objects.front(), glm::translate(Mat4(1), Vec3(0.05, 0, 0))};
  SolveSettings limited = coarse();
  limited.seconds = 600;
  Engine engine(furnishedRoom(), limited), withoutHaste(furnishedRoom(), coarse());
  ASSERT_TRUE(engine.solve().converged);
  withoutHaste.solve();
  engine.apply(edit), withoutHaste.apply(edit);
  EXPECT_EQ(engine.update().rays, withoutHaste.update().rays);
  EXPECT_TRUE(engine.solution().report().converged);
  EXPECT_EQ(hashOf(engine), hashOf(withoutHaste));
}

TEST(LineUpdate, AsksOtherLampsNotAgainWhereOneMoves) {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  addBox(scene, white, {1, 1, 0.5}, {2, 2, 0.7}, false);
  for (int i = 0; i < 6; ++i) {
    addLight(scene, PointLight{{0.4 + 0.6 * i, 0.4 + 0.4 * i, 2.2}, Rgb(1.0f)});
    scene.lights.back().name = "lamp" + std::to_string(i);
  }
  Engine engine(std::move(scene), coarse());
  engine.solve();
  engine.apply(MoveLight{"lamp2", Vec3(0.3, 0, -0.1)});
  const std::uint64_t rays = engine.update().rays;
  EXPECT_TRUE(isTheFreshOne(engine));
  Engine fresh(engine.solution().scene(), coarse());
  EXPECT_LT(static_cast<double>(rays), 0.4 * static_cast<double>(fresh.solve().counts.raysVisibility));
}

TEST(LineUpdate, FollowsAnEditThatComesAfterOneBeforeTheSolve) {
  Engine engine(furnishedRoom(), coarse());
  const std::string object = editableOfFurnishedRoom().objects.front();
  engine.apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0.02, 0, 0))});
  engine.solve();
  engine.apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0, 0.05, 0))});
  engine.update();
  EXPECT_TRUE(isTheFreshOne(engine));
}

/// Stops what runs when it has been asked so often.
struct StopsAfter : Progress {
  explicit StopsAfter(int asked) : left(asked) {}
  void report(std::string_view, double) override {}
  bool stopRequested() const override { return left-- == 0; }
  mutable int left;
};

/// How often `work` asks whether to stop.
template <class Work>
int asksOf(const Work& work) {
  StopsAfter never(std::numeric_limits<int>::max());
  work(never);
  return std::numeric_limits<int>::max() - never.left;
}

TEST(LineUpdate, GoesOnFromNothingWhenItWasInterrupted) {
  const std::string object = editableOfFurnishedRoom().objects.front();
  const auto moved = [&] {
    auto engine = std::make_unique<Engine>(furnishedRoom(), coarse());
    engine->solve();
    engine->apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0.05, 0, 0))});
    return engine;
  };
  const int all = asksOf([&](Progress& progress) { moved()->update(&progress); });
  for (const int asked : {0, 1, 2, 5, all - 3, all - 1}) {
    const std::unique_ptr<Engine> engine = moved();
    StopsAfter stops(asked);
    EXPECT_THROW(engine->update(&stops), Interrupted) << asked;
    engine->update();
    EXPECT_TRUE(isTheFreshOne(*engine)) << asked;
    engine->apply(TransformObject{object, glm::translate(Mat4(1), Vec3(0, 0.05, 0))});
    engine->update();
    EXPECT_TRUE(isTheFreshOne(*engine)) << asked;
  }
}

TEST(LineSolve, GoesOnWhereItWasInterrupted) {
  const int all = asksOf([](Progress& progress) { Engine(furnishedRoom(), coarse()).solve(&progress); });
  for (const int asked : {0, 3, all / 2, all - 3, all - 1}) {
    Engine engine(furnishedRoom(), coarse());
    StopsAfter stops(asked);
    EXPECT_THROW(engine.solve(&stops), Interrupted) << asked;
    engine.solve();
    EXPECT_TRUE(isTheFreshOne(engine)) << asked;
  }
}

TEST(LineUpdate, FollowsLinesBetweenFacingMirrors) {
  // Behind the second mirror they run as they did before the first.
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  const MaterialId mirror = addMaterial(scene, "mirror", Mirror{Rgb(0.9f)});
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  addPolygon(scene, mirror, {{0.01, 0.2, 0.2}, {0.01, 2.8, 0.2}, {0.01, 2.8, 2.3}, {0.01, 0.2, 2.3}});
  addPolygon(scene, mirror, {{3.99, 0.2, 0.2}, {3.99, 0.2, 2.3}, {3.99, 2.8, 2.3}, {3.99, 2.8, 0.2}});
  addLight(scene, PointLight{{2, 1.5, 2.4}, Rgb(1.0f)});
  addBlock(scene, "board", white, {1, 1, 0.6}, {1.1, 1.4, 1});
  Engine engine(std::move(scene), coarse());
  engine.solve();
  for (int i = 0; i < 3; ++i) {
    engine.apply(TransformObject{"board", glm::translate(Mat4(1), Vec3(0.4, 0.15, 0.1))});
    engine.update();
  }
  EXPECT_TRUE(isTheFreshOne(engine));
}

}  // namespace
}  // namespace deltalux
