// Long sessions: 160 edits of a room, 20 at a time out and back, 200 out and back at once, and 200 of the lodge.
#include <deltalux/io.hpp>

#include "support/furnished_room.hpp"
#include "support/shared.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

TEST(RandomEditsSlow, OutAndBackAgainAndAgainMemoryLevelsOff) {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000;
  Engine engine(test::furnishedRoom(), settings);
  engine.solve();
  const std::size_t start = test::heldBytes(engine);
  test::RandomEdits edits(engine, test::editableOfFurnishedRoom(), 7);
  std::vector<std::size_t> held;
  for (int cycle = 0; cycle < 4; ++cycle) {
    for (int i = 0; i < 20; ++i) {
      edits.step();
      test::expectValid(engine, edits.last());
    }
    edits.undoAll();
    test::expectAsSolved(engine, settings, 0.01, 0.08);
    held.push_back(test::heldBytes(engine));
  }
  // Leaves that were split for a shadow stay split, until there are none to split any more.
  EXPECT_LT(static_cast<double>(held[3]), 1.1 * static_cast<double>(held[2]));
  EXPECT_LT(held[3], 3 * start);
}

TEST(RandomEditsSlow, TwoHundredOutAndBack) {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000;
  Engine engine(test::furnishedRoom(), settings);
  engine.solve();
  test::RandomEdits edits(engine, test::editableOfFurnishedRoom(), 7);
  for (int i = 0; i < 200; ++i) {
    edits.step();
    test::expectValid(engine, edits.last());
    if (i == 159) test::expectAsSolved(engine, settings, 0.015, 0.05);  // with lights on
  }
  edits.undoAll();
  test::expectValid(engine, "undo");
  test::expectAsSolved(engine, settings, 0.01, 0.05);
}

TEST(RandomEditsSlow, TwoHundredOnTheLodge) {
  SolveSettings settings;
  settings.error = 0.1;
  Engine engine(loadScene({test::sourceFolder() / "scenes/lodge/morning.rad"}).scene, settings);
  engine.solve();
  const std::size_t start = test::heldBytes(engine);
  test::RandomEdits edits(
      engine,
      {{"container", "dresser_bowl", "ring", "chest_vase", "crystal_ball", "stool", "piano_stool", "metronome",
        "reading_chair", "coffee_table", "dresser_mirror", "picture_east", "side_table"},
       {"sofa_lamp", "reading_lamp", "chandelier", "bedside_lamp", "basin_lamp", "sky"},
       {"dresser_spot", "chest_spot"},
       {"bedroom_paint", "east_wall_paint", "living_paint", "oak", "walnut", "pine", "floor_light"},
       {"oak"},
       0.3},
      11);
  for (int i = 0; i < 200; ++i) {
    edits.step();
    test::expectValid(engine, edits.last());
  }
  EXPECT_LT(test::heldBytes(engine), 2 * start);
  Engine fresh(engine.solution().scene(), settings);
  fresh.solve();
  const CheckReport check = compareSolutions(engine.solution(), fresh.solution(), test::kQuickCheck);
  EXPECT_TRUE(check.particlesIdentical);
  // Under the trees, in the attic and behind the logs there is a hundredth of the mean irradiance of a sunny morning. A
  // solve of this error is far off there, relatively: no two have to agree better than either does with an exact one.
  SolveSettings exact = settings;
  exact.error = 0.03;
  Engine finer(engine.solution().scene(), exact);
  finer.solve();
  const CheckReport own = compareSolutions(fresh.solution(), finer.solution(), test::kQuickCheck);
  EXPECT_LT(check.medianRelDiff, 1.5 * own.medianRelDiff);
  EXPECT_LT(check.p95RelDiff, own.p95RelDiff);
  const CheckReport updated = compareSolutions(engine.solution(), finer.solution(), test::kQuickCheck);
  EXPECT_LT(updated.p95RelDiff, 1.5 * own.p95RelDiff);
  EXPECT_LT(updated.medianRelDiff, 2 * own.medianRelDiff);
}

}  // namespace
}  // namespace deltalux
