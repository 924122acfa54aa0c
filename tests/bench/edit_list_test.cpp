// Lists of edits to measure: they fit the scenes, forget nothing, and say where things move.
#include "edit_list.hpp"

#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <map>

#include "support/shared.hpp"

namespace deltalux::bench {
namespace {

namespace fs = std::filesystem;

fs::path listOf(const std::string& name) { return test::sourceFolder() / "bench" / "edits" / (name + ".txt"); }

Scene lit(const fs::path& file, double metresPerUnit = 1) {
  ImportSettings import;
  import.metresPerUnit = metresPerUnit;
  Scene scene = loadScene({file}, import).scene;
  addAreaLights(scene);
  return scene;
}

/// Every edit of the list can be done in its turn, and does something.
void expectFits(const std::string& name, Scene scene) {
  const std::vector<EditPhase> phases = loadEditList(listOf(name), scene);
  std::map<std::string, int> count;  // by kind
  for (const EditPhase& phase : phases)
    for (const NamedEdit& e : phase.edits) {
      const SceneChange change = applyEdit(scene, e.edit).change;
      EXPECT_FALSE(change.moved.empty() && change.lights.empty() && change.materials.empty()) << e.subject;
      EXPECT_EQ(e.kind == "move lamp", !change.lights.empty() && !change.moved.empty()) << e.subject;
      ++count[e.kind];
    }
  for (const char* kind : {"move", "dim", "off", "on", "move lamp", "paint"}) EXPECT_GE(count[kind], 1) << kind;
  EXPECT_NO_THROW(validate(scene));
}

TEST(EditLists, FitTheBundledScenes) {
  const fs::path scenes = test::sourceFolder() / "scenes";
  expectFits("cornell", lit(scenes / "cornell" / "cornell.rad"));
  expectFits("lodge", lit(scenes / "lodge" / "morning.rad"));
  expectFits("street", lit(scenes / "street" / "day.rad"));
}

TEST(EditLists, FitTheCabin) {
  DELTALUX_SHARED_OR_SKIP(shared);
  expectFits("cabin", lit(shared / "scenes" / "cabin" / "cabin.rad", 0.3048));
}

/// A lamp, a table with a cup on it, and a wall, in a scene in feet.
Scene room() {
  Scene scene;
  scene.metresPerUnit = 0.3048;
  scene.materials = {{"paint", Opaque{Rgb(0.5f), {}, {}}, {}}, {"glow", Opaque{Rgb(0.0f), {}, {}}, {}}};
  scene.materials[1].emission = Emission{Rgb(10.0f), false, {}};
  const auto ball = [&](const char* name, const Vec3& center, int material) {
    scene.primitives.push_back(
        {Sphere{center, 0.5, false}, MaterialId(std::size_t(material)), internObject(scene, name, '.')});
  };
  ball("table", {9, 5, 1}, 0);
  ball("table.cup", {5, 2, 2}, 0);
  ball("lamp.bulb", {5, 9, 4}, 1);
  ball("wall", {0, 5, 2}, 0);
  addAreaLights(scene);
  return scene;
}

std::vector<EditPhase> parsed(const std::string& text) { return parseEditList(text, "list.txt", room()); }

TEST(EditLists, ThingsMoveAwayFromTheNearestWallByMetres) {
  const auto phases = parsed("step 0.3048\nroom hall 0 0 10 10\nmove table.cup table  # both\nlamp lamp\nfixed wall\n");
  ASSERT_EQ(phases.size(), 3u);
  const auto offset = [](const NamedEdit& e) { return Vec3(std::get<TransformObject>(e.edit).matrix[3]); };
  const auto& moves = phases[0].edits;
  ASSERT_EQ(moves.size(), 2u);
  EXPECT_EQ(moves[0].subject, "table.cup");
  EXPECT_LT(glm::distance(offset(moves[0]), Vec3(0, 1, 0)), 1e-12);
  EXPECT_LT(glm::distance(offset(moves[1]), Vec3(-1, 0, 0)), 1e-12);  // with its cup: from the east
  const auto& lamps = phases[1].edits;
  ASSERT_EQ(lamps.size(), 4u);
  EXPECT_EQ(std::get<ScaleLight>(lamps[0].edit).factor, 0.5f);
  EXPECT_FALSE(std::get<SwitchLight>(lamps[1].edit).on);
  EXPECT_TRUE(std::get<SwitchLight>(lamps[2].edit).on);
  EXPECT_LT(glm::distance(offset(lamps[3]), Vec3(0, -1, 0)), 1e-12);
  EXPECT_TRUE(phases[2].edits.empty());
}

TEST(EditLists, AStarStandsForAllDirectlyBelow) {
  const auto phases = parsed("step 1\nroom hall 0 0 10 10\nmove table.*\nfixed lamp wall\npaint paint 0.1 0.2 0.3\n");
  ASSERT_EQ(phases[0].edits.size(), 1u);
  EXPECT_EQ(phases[0].edits[0].subject, "table.cup");
  EXPECT_EQ(*std::get<SetMaterial>(phases[2].edits.at(0).edit).reflectance, Rgb(0.1f, 0.2f, 0.3f));
}

TEST(EditLists, RefuseWhatTheyCannotMean) {
  const auto expectRefused = [](const std::string& text, int line, const std::string& message) {
    try {
      parsed(text);
      ADD_FAILURE() << "taken: " << text;
    } catch (const InputError& e) {
      EXPECT_EQ(e.line(), line) << text;
      EXPECT_NE(e.message().find(message), std::string::npos) << e.message();
    }
  };
  const std::string head = "step 1\nroom hall 0 0 10 10\n";
  expectRefused(head + "fixed table lamp\n", 0, "no object 'wall'");
  expectRefused(head + "move chair\n", 3, "no object 'chair'");
  expectRefused(head + "move wall.*\n", 3, "no object 'wall.*'");
  expectRefused(head + "move wall\nfixed wall\n", 4, "twice");
  expectRefused(head + "lamp table\n", 3, "no light");
  expectRefused(head + "paint varnish 0.1 0.1 0.1\n", 3, "varnish");
  expectRefused(head + "paint paint 0.1 0.1\n", 3, "number");
  expectRefused(head + "paint paint 0.1 0.1 0.1 0.1\n", 3, "too much");
  expectRefused("\nroom hall 0 0 0 10\n", 2, "area");
  expectRefused("step 1\nmove wall\n", 2, "room");
  expectRefused("room hall 0 0 10 10\nmove wall\n", 2, "step");
  expectRefused("carry wall\n", 1, "carry");
}

}  // namespace
}  // namespace deltalux::bench
