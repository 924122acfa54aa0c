// Edits of all kinds in a row: everything holds together, the end is what a fresh solve gives, and so is the way back.
#include "support/furnished_room.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

TEST(RandomEdits, HoldTogetherAndEndWhereAFreshSolveDoes) {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000;
  Engine engine(test::furnishedRoom(), settings);
  engine.solve();
  test::RandomEdits edits(engine, test::editableOfFurnishedRoom(), 7);
  for (int i = 0; i < 20; ++i) {
    edits.step();
    test::expectValid(engine, edits.last());
  }
  test::expectAsSolved(engine, settings, 0.01, 0.08);
  edits.undoAll();
  test::expectValid(engine, "undo");
  test::expectAsSolved(engine, settings, 0.01, 0.08);
}

}  // namespace
}  // namespace deltalux
