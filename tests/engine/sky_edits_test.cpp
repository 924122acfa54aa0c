// Sun and sky of another time: an update, to what a solve gives.
#include <gtest/gtest.h>

#include "support/rooms.hpp"
#include "support/update_checks.hpp"

namespace deltalux {
namespace {

using namespace test;

Daylighting daylightAt(const char* time, const char* sky) {
  Daylighting daylight;
  daylight.sky = parseSkyModel(sky).value(), daylight.time = parseCivilTime(time).value();
  daylight.place = {47.37, 8.54};
  return daylight;
}

/// A room without a wall towards the south, a table in it, under the sky of a morning.
Scene southRoom() {
  Scene scene;
  const MaterialId white = addMaterial(scene, "white", lambert(0.5f));
  addBox(scene, white, Vec3(0), {4, 3, 2.5}, true);
  std::erase_if(scene.primitives, [](const Primitive& p) { return bounds(p.shape).upper.y <= 0; });
  addBox(scene, white, {1, 1, 0.6}, {2, 2, 0.7}, false);
  setDaylight(scene, daylightAt("2026-03-20T09:00", "perez:500,120"));
  return scene;
}

SolveSettings coarser() {
  SolveSettings settings;
  settings.error = 0.3, settings.particles = 5000;
  return settings;
}

TEST(SkyEdits, AreUpdatesToWhatASolveGives) {
  const SolveSettings settings = coarser();
  Engine engine(southRoom(), settings);
  engine.solve();
  for (const auto& [time, sky] : {std::pair("2026-03-20T12:00", "perez:500,120"),
                                  {"2026-03-20T12:00", "perez:0,120"},
                                  {"2026-03-20T15:00", "cie:12"},
                                  {"2026-03-20T23:00", "cie:12"},
                                  {"2026-03-20T09:00", "perez:500,120"}}) {
    engine.apply(SetDaylight{daylightAt(time, sky)});
    const StepReport step = engine.update();
    EXPECT_EQ(step.op, "sky");
    EXPECT_TRUE(isTheFreshOne(engine)) << time << sky;
    Engine fresh(engine.solution().scene(), settings);
    const WorkCounts solved = fresh.solve().counts;
    EXPECT_LT(step.rays, solved.raysVisibility + solved.raysParticles) << time << sky;
    expectValid(engine, time);
    if (std::string_view(time) == "2026-03-20T15:00") expectAsSolved(engine, settings, 1e-4, 1e-3);
  }
}

TEST(SkyEdits, LightKeptApartFollows) {
  SolveSettings settings = coarser();
  settings.byLight = true;
  Engine engine(southRoom(), settings);
  engine.solve();
  engine.apply(SetDaylight{daylightAt("2026-03-20T09:00", "perez:250,200")});  // the sun as it stood, another light
  engine.update();
  expectAsSolved(engine, settings, 1e-4, 1e-3);
}

TEST(SkyEdits, AnUnlitRoomGetsASky) {
  Scene dark = southRoom();
  dark.lights.clear();
  addLight(dark, PointLight{{2, 1.5, 2.3}, Rgb(5.0f)});
  Engine engine(std::move(dark), coarser());
  engine.solve();
  engine.apply(SetDaylight{daylightAt("2026-03-20T12:00", "cie:12")});
  engine.update();
  expectAsSolved(engine, coarser(), 1e-4, 1e-3);
}

TEST(SkyEdits, ThePapersMethodFollows) {
  SolveSettings settings = coarse();
  settings.method = SolveMethod::Paper;
  Engine engine(southRoom(), settings);
  engine.solve();
  for (const auto& [time, sky] : {std::pair("2026-03-20T12:00", "perez:500,120"), {"2026-03-20T12:00", "cie:5"}}) {
    engine.apply(SetDaylight{daylightAt(time, sky)});
    engine.update();
    Engine fresh(engine.solution().scene(), settings);
    fresh.solve();
    const CheckReport check = compareSolutions(engine.solution(), fresh.solution(), kQuickCheck);
    EXPECT_LT(check.medianRelDiff, 0.05) << time << sky;
    EXPECT_LT(check.p95RelDiff, 0.3) << time << sky;
  }
}

}  // namespace
}  // namespace deltalux
