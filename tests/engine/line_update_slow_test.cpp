// Long sessions over lines: after each of 200 random edits of a room the solution is the fresh one, bit for bit in
// mesh, lines and particles; after many of bigger scenes too; and memory does not grow.
#include <gtest/gtest.h>

#include <array>
#include <deltalux/io.hpp>

#include "base/freed_memory.hpp"
#include "support/furnished_room.hpp"
#include "support/shared.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

using namespace test;

SolveSettings settingsOf(double error, std::uint64_t particles = 0) {
  SolveSettings settings;
  settings.error = error, settings.particles = particles;
  return settings;
}

/// Edits of what is not there are passed over without a word.
void expectAllThere(const Scene& scene, const Editable& what) {
  for (const std::string& name : what.objects) EXPECT_FALSE(findObjects(scene, name).empty()) << name;
  for (const std::string& name : what.lights) EXPECT_NO_THROW(validateEdit(scene, ScaleLight{name, 0.5f})) << name;
  for (const std::string& name : what.placed) EXPECT_NO_THROW(validateEdit(scene, MoveLight{name, Vec3(0.01)})) << name;
  for (const std::string& name : what.paints)
    EXPECT_NO_THROW(validateEdit(scene, SetMaterial{name, Rgb(0.5f), {}})) << name;
  for (const std::string& name : what.rough) EXPECT_NO_THROW(validateEdit(scene, SetMaterial{name, {}, 0.2f})) << name;
}

/// 20 edits of a bundled scene, held against a fresh solve after every so many.
void expectTheFreshSolution(const char* file, const Editable& what, std::uint64_t seed, int every) {
  Engine engine(loadScene({sourceFolder() / "scenes" / file}).scene, settingsOf(0.1));
  expectAllThere(engine.solution().scene(), what);
  engine.solve();
  RandomEdits edits(engine, what, seed);
  for (int i = 0; i < 20; ++i) {
    edits.step();
    if ((i + 1) % every == 0) {
      ASSERT_TRUE(isTheFreshOne(engine)) << edits.last();
    }
  }
}

TEST(LineUpdateSlow, TwoHundredEditsOfARoom) {
  Engine engine(furnishedRoom(), settingsOf(0.1, 20000));
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 23);
  for (int i = 0; i < 200; ++i) {
    edits.step();
    ASSERT_TRUE(isTheFreshOne(engine)) << edits.last();
  }
}

TEST(LineUpdateSlow, TwentyEditsOfTheLodge) {
  expectTheFreshSolution(
      "lodge/morning.rad",
      {{"container", "dresser_bowl", "ring", "chest_vase", "crystal_ball", "stool", "metronome", "reading_chair",
        "coffee_table", "dresser_mirror", "picture_east", "side_table"},
       {"sofa_lamp", "reading_lamp", "chandelier", "bedside_lamp", "basin_lamp", "sky"},
       {"dresser_spot", "chest_spot"},
       {"bedroom_paint", "east_wall_paint", "living_paint", "oak", "silvering", "pine", "floor_light"},
       {"brass", "steel"},
       0.3},
      5, 5);
}

TEST(LineUpdateSlow, TwentyEditsOfTheStreet) {
  expectTheFreshSolution("street/day.rad",
                         {{"car", "parked.0", "cafe", "bollards", "sun_sign", "sun_sign_arms"},
                          {"lanterns", "lanterns_east", "bakery_sign", "cafe_sign", "sky"},
                          {"lanterns"},
                          {"stucco_ochre", "stucco_rose", "brick", "limestone", "asphalt"},
                          {"cladding"},
                          0.3},
                         5, 5);
}

/// Random edits of all things, lamps and materials of a scene, held against a fresh solve after each ten.
void expectTheFreshSolutionOfAll(Scene scene, const char* list, std::uint64_t seed) {
  const Editable all = everythingIn(scene, sourceFolder() / "bench" / "edits" / list);
  expectAllThere(scene, {all.objects, {}, {}, {}, {}});
  Engine engine(std::move(scene), settingsOf(0.1));
  engine.solve();
  RandomEdits edits(engine, all, seed);
  for (int i = 1; i <= 60; ++i) {
    edits.step();
    if (i % 10 == 0) {
      ASSERT_TRUE(isTheFreshOne(engine)) << edits.last();
    }
  }
}

TEST(LineUpdateSlow, SixtyEditsOfAllThatIsInTheLodge) {
  expectTheFreshSolutionOfAll(loadScene({sourceFolder() / "scenes/lodge/morning.rad"}).scene, "lodge.txt", 1);
}

TEST(LineUpdateSlow, SixtyEditsOfAllThatIsInTheCabin) {
  DELTALUX_SHARED_OR_SKIP(shared);
  Scene scene = loadScene({shared / "scenes/cabin/cabin.rad"}).scene;
  scene.metresPerUnit = 0.3048;
  expectTheFreshSolutionOfAll(std::move(scene), "cabin.txt", 2);
}

TEST(LineUpdateSlow, MemoryIsFlat) {
  if (residentBytes() == 0) GTEST_SKIP() << "no /proc/self/statm here";
  Engine engine(furnishedRoom(), settingsOf(0.05));
  engine.solve();
  RandomEdits edits(engine, editableOfFurnishedRoom(), 29);
  // In the first and in the later half, each time from the same scene on.
  std::array<std::uint64_t, 2> most{};
  for (int i = 0; i < 200; ++i) {
    edits.step();
    std::uint64_t& of = most[i < 100 ? 0 : 1];
    of = std::max(of, residentBytes());
    if (i % 20 == 19) edits.undoAll();
  }
  EXPECT_LE(static_cast<double>(most[1]), 1.15 * static_cast<double>(most[0]));
}

}  // namespace
}  // namespace deltalux
