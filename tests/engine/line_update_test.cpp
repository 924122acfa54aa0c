// An update over lines is a fresh solve of the edited scene, bit for bit in mesh, lines and particles.
#include <gtest/gtest.h>

#include "support/furnished_room.hpp"
#include "support/solved_by_lines.hpp"

namespace deltalux {
namespace {

using namespace test;

SolveSettings settingsOf() {
  SolveSettings settings;
  settings.error = 0.05, settings.particles = 20000, settings.method = SolveMethod::Lines;
  return settings;
}

TEST(LineUpdate, IsTheFreshSolveAfterEachOfManyEdits) {
  Engine engine(furnishedRoom(), settingsOf());
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 11);
  for (int i = 0; i < 12; ++i) {
    edits.step();
    Engine fresh(engine.solution().get().scene, settingsOf());
    fresh.solve();
    ASSERT_EQ(hashOf(engine), hashOf(fresh)) << i << ": " << edits.last();
  }
}

}  // namespace
}  // namespace deltalux
