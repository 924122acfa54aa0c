// Edits and recordings in files.
#include <gtest/gtest.h>

#include <deltalux/edit_io.hpp>
#include <deltalux/error.hpp>

#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::TempFolder;

std::vector<EditStep> parse(const std::string& entries) {
  return parseEdits("{\"edits\": [" + entries + "]}", "e.json", ".");
}
template <class T>
T only(const std::string& entry) {
  const auto steps = parse(entry);
  EXPECT_EQ(steps.size(), 1u);
  return std::get<T>(std::get<Edit>(steps.at(0)));
}
std::string refusal(const std::string& text) {
  try {
    parseEdits(text, "e.json", ".");
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "e.json");
    EXPECT_FALSE(error.hint().empty());
    return std::to_string(error.line()) + ": " + error.message();
  }
  ADD_FAILURE() << "was read: " << text;
  return {};
}
std::string refused(const std::string& entry) { return refusal("{\"edits\": [" + entry + "]}"); }
bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(EditsFile, ReadsEveryOperation) {
  const auto shift = only<TransformObject>(R"({"op": "transform", "object": "cup", "translate": [1, 2, 3]})");
  EXPECT_EQ(shift.object, "cup");
  EXPECT_EQ(Vec3(shift.matrix[3]), Vec3(1, 2, 3));
  const auto turn = only<TransformObject>(
      R"({"op": "transform", "object": "cup", "rotate": {"axis": [0, 0, 2], "degrees": 90, "about": [1, 0, 0]}})");
  EXPECT_NEAR(glm::distance(Vec3(turn.matrix * glm::dvec4(2, 0, 0, 1)), Vec3(1, 1, 0)), 0, 1e-12);
  const auto matrix =
      only<TransformObject>(R"({"op": "transform", "object": "cup", "matrix": [1,0,0,5, 0,1,0,6, 0,0,1,7, 0,0,0,1]})");
  EXPECT_EQ(Vec3(matrix.matrix[3]), Vec3(5, 6, 7)) << "row-major";
  EXPECT_EQ(only<ScaleLight>(R"({"op": "light", "light": "l", "scale": 0.5})").factor, 0.5f);
  EXPECT_EQ(only<ColourLight>(R"({"op": "light", "light": "l", "rgb": [1, 0.5, 0]})").rgb, Rgb(1, 0.5f, 0));
  EXPECT_FALSE(only<SwitchLight>(R"({"op": "light", "light": "l", "on": false})").on);
  EXPECT_EQ(only<AimLight>(R"({"op": "light", "light": "l", "aim": [0, 0, 1]})").direction, Vec3(0, 0, 1));
  EXPECT_EQ(only<MoveLight>(R"({"op": "light", "light": "l", "translate": [0, 1, 0]})").offset, Vec3(0, 1, 0));
  const auto material = only<SetMaterial>(R"({"op": "material", "material": "m", "reflectance": [0.1, 0.2, 0.3]})");
  EXPECT_EQ(material.reflectance, Rgb(0.1f, 0.2f, 0.3f));
  EXPECT_FALSE(material.roughness);
  EXPECT_EQ(only<SetMaterial>(R"({"op": "material", "material": "m", "roughness": 0.25})").roughness, 0.25f);
  EXPECT_EQ(only<RemoveObject>(R"({"op": "remove", "object": "cup"})").object, "cup");
  const auto steps = parse(R"({"op": "remove", "object": "a"}, {"op": "undo"}, {"op": "redo"})");
  EXPECT_TRUE(std::holds_alternative<Undo>(steps.at(1)));
  EXPECT_TRUE(std::holds_alternative<Redo>(steps.at(2)));
}

TEST(EditsFile, MistakesAreNamedWithTheirPlace) {
  EXPECT_TRUE(contains(refusal("{\"edits\": [\n{\"op\": \"remove\",\n}]}"), "3: is not JSON"));
  EXPECT_TRUE(contains(refusal("{}"), "/edits is missing"));
  EXPECT_TRUE(contains(refusal("[]"), "is not an object"));
  EXPECT_TRUE(contains(refused("7"), "/edits/0 is not an object"));
  EXPECT_TRUE(contains(refused(R"({"op": "transfrom", "object": "a"})"), "nearest: transform"));
  EXPECT_TRUE(contains(refused(R"({"object": "a"})"), "/edits/0/op is missing"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a"})"), "needs one of translate, rotate, matrix"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "translate": [1, 2, 3]})"), "/object is missing"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "translate": [1, 2]})"), "has 2 numbers"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "translate": [1, 2, "3"]})"), "is not a number"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "translate": [0,0,0], "matrix": []})"), "both"));
  EXPECT_TRUE(
      contains(refused(R"({"op": "transform", "object": "a", "translat": [0,0,0]})"), "unknown key 'translat'"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "rotate": {"axis": [0,0,0], "degrees": 1}})"),
                       "no length"));
  EXPECT_TRUE(
      contains(refused(R"({"op": "transform", "object": "a", "rotate": {"axis": [0,0,1]}})"), "degrees is missing"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "matrix": [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]})"),
                       "flattens"));
  EXPECT_TRUE(contains(refused(R"({"op": "transform", "object": "a", "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1]})"),
                       "last row"));
  EXPECT_TRUE(contains(refused(R"({"op": "light", "light": "a", "scale": -1})"), "not in 0"));
  EXPECT_TRUE(contains(refused(R"({"op": "light", "light": "a", "scale": 1e999})"), "number"));
  EXPECT_TRUE(contains(refused(R"({"op": "light", "light": "a", "on": 1})"), "neither true nor false"));
  EXPECT_TRUE(contains(refused(R"({"op": "material", "material": "a"})"), "neither reflectance nor roughness"));
  EXPECT_TRUE(contains(refused(R"({"op": "material", "material": "a", "reflectance": [0, 0, 1.5]})"), "not in 0 to 1"));
  EXPECT_TRUE(contains(refused(R"({"op": "add", "object": "a", "scene": "../secret.rad"})"), "outside its folder"));
  EXPECT_TRUE(contains(refused(R"({"op": "undo"})"), "nothing to undo"));
  EXPECT_TRUE(contains(refused(R"({"op": "remove", "object": "a"}, {"op": "redo"})"), "/edits/1 has nothing to redo"));
}

constexpr const char* kRoom =
    "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light glow 0 0 3 5 5 5\n"
    "grey sphere ball 0 0 4 0 0 0 1\nglow polygon lamp 0 0 12 0 0 3 0 1 3 1 1 3 1 0 3\n";

TEST(EditsFile, SkiesSayWhatTheyChange) {
  const std::vector<EditStep> steps = parseEdits(
      R"({"edits": [{"op": "sky", "sky": "perez:800,100", "when": "2026-06-21T09:00+02:00", "where": [47.4, 8.5], "north": 10},
                    {"op": "sky", "when": "2026-06-21T10:00+02:00"}, {"op": "sky", "sky": "cie:1", "ground": 0.5}]})",
      "e.json", ".");
  ASSERT_EQ(steps.size(), 3u);
  const auto daylight = [&](std::size_t i) { return std::get<SetDaylight>(std::get<Edit>(steps[i])).daylight; };
  EXPECT_EQ(daylight(0), (Daylighting{AllWeatherSky{800, 100}, {2026, 6, 21, 9, 2.0}, {47.4, 8.5}, 10, 0.2}));
  EXPECT_EQ(daylight(1), (Daylighting{AllWeatherSky{800, 100}, {2026, 6, 21, 10, 2.0}, {47.4, 8.5}, 10, 0.2}));
  EXPECT_EQ(daylight(2), (Daylighting{GeneralSky{1, {}}, {2026, 6, 21, 10, 2.0}, {47.4, 8.5}, 10, 0.5}));
  for (const char* entry :
       {R"({"op": "sky", "when": "2026-06-21T09:00"})", R"({"op": "sky", "sky": "cie:1", "when": "2026-06-21T09:00"})",
        R"({"op": "sky", "sky": "cie:16", "when": "2026-06-21T09:00", "where": [0, 0]})",
        R"({"op": "sky", "sky": "cie:1", "when": "noon", "where": [0, 0]})",
        R"({"op": "sky", "sky": "cie:1", "when": "2026-06-21T09:00", "where": [120, 0]})",
        R"({"op": "sky", "sky": "cie:1", "when": "2026-06-21T09:00", "where": [0, 0], "ground": 2})",
        R"({"op": "sky", "sky": "cie:1", "when": "2026-06-21T09:00", "where": [0, 0], "lat": 2})"})
    EXPECT_THROW(parseEdits(std::string(R"({"edits": [)") + entry + "]}", "e.json", "."), InputError) << entry;
}

TEST(EditsFile, AddReadsTheFileBesideIt) {
  const TempFolder folder;
  folder.write("cup.rad", "void plastic blue 0 0 5 .1 .1 .5 0 0\nblue cylinder cup.side 0 0 7 0 0 0 0 0 1 .5\n");
  folder.write("room.rad", kRoom);
  const auto file = folder.write("e.json", R"({"edits": [{"op": "add", "object": "mug", "scene": "cup.rad",
    "matrix": [1,0,0,9, 0,1,0,0, 0,0,1,0, 0,0,0,1]}, {"op": "remove", "object": "mug.cup"}, {"op": "undo"}]})");
  const auto steps = loadEdits(file);
  Scene scene = loadScene({folder / "room.rad"}).scene;
  EXPECT_NO_THROW(validateEdits(scene, steps, "e.json"));
  EditHistory history;
  for (const EditStep& step : steps) applyStep(scene, history, step);
  ASSERT_EQ(scene.primitives.size(), 3u);
  EXPECT_EQ(std::get<Cylinder>(scene.primitives[2].shape).p0, Vec3(9, 0, 0));
  EXPECT_NO_THROW(validate(scene));
  EXPECT_THROW(loadEdits(folder.write("f.json", R"({"edits": [{"op": "add", "object": "a", "scene": "no.rad"}]})")),
               InputError);
}

TEST(EditsFile, ValidationNamesTheStep) {
  const TempFolder folder;
  const Scene scene = loadScene({folder.write("room.rad", kRoom)}).scene;
  const auto steps = parse(R"({"op": "remove", "object": "ball"}, {"op": "light", "light": "lump", "scale": 2})");
  try {
    validateEdits(scene, steps, "e.json");
    FAIL() << "there is no such light";
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.message(), "edit 2: there is no light 'lump'"));
    EXPECT_TRUE(contains(error.hint(), "lamp"));
  }
}

TEST(Recording, ComesBackAndReplaysTheSame) {
  const TempFolder folder;
  Recording recording;
  recording.scene = {folder.write("room.rad", kRoom)};
  recording.import.metresPerUnit = 0.3048;
  recording.settings.error = 0.1, recording.settings.seed = 18446744073709551615u,
  recording.settings.diffuseOnly = true, recording.settings.causticTextures = false;
  recording.settings.reemittedShare = 0.25;
  recording.luminaires = {{folder / "lamp.ies", {1, 2, 3}}};
  recording.steps = parse(
      R"({"op": "transform", "object": "ball", "rotate": {"axis": [1, 2, 3], "degrees": 33.3, "about": [0.1, 0.2, 0.3]}},
    {"op": "light", "light": "lamp", "scale": 0.1}, {"op": "light", "light": "lamp", "rgb": [0.1, 0.2, 0.3]},
    {"op": "light", "light": "lamp", "on": false}, {"op": "light", "light": "lamp", "translate": [0.1, 0, 0]},
    {"op": "material", "material": "grey", "reflectance": [0.3, 0.2, 0.1]}, {"op": "undo"}, {"op": "undo"}, {"op": "redo"},
    {"op": "remove", "object": "ball"})");
  recording.daylight = Daylighting{GeneralSky{12, {}}, {2026, 6, 21, 9, 2.0}, {47.4, 8.5}, 10, 0.3};
  recording.steps.emplace_back(Edit(SetDaylight{*recording.daylight}));
  saveRecording(folder / "r.json", recording);
  const Recording loaded = loadRecording(folder / "r.json");
  EXPECT_EQ(loaded.daylight, recording.daylight);
  EXPECT_EQ(toJson(loaded), toJson(recording));
  EXPECT_EQ(loaded.settings.seed, recording.settings.seed);
  EXPECT_EQ(loaded.settings.diffuseOnly, true);
  EXPECT_EQ(loaded.settings.causticTextures, false);
  EXPECT_EQ(loaded.settings.reemittedShare, 0.25);
  EXPECT_EQ(loaded.scene, recording.scene);
  ASSERT_EQ(loaded.luminaires.size(), 1u);
  EXPECT_EQ(loaded.luminaires[0].file, recording.luminaires[0].file);
  EXPECT_EQ(loaded.luminaires[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(loaded.import.metresPerUnit, 0.3048);
  ASSERT_EQ(loaded.steps.size(), recording.steps.size());
  const auto play = [](const Recording& r) {
    Scene scene = loadScene(r.scene, r.import).scene;
    EditHistory history;
    for (const EditStep& step : r.steps) applyStep(scene, history, step);
    return scene;
  };
  const Scene a = play(recording), b = play(loaded);
  for (std::size_t i = 0; i < a.primitives.size(); ++i)
    EXPECT_EQ(bounds(a.primitives[i].shape).upper, bounds(b.primitives[i].shape).upper);
  EXPECT_EQ(a.lights[0].scale, b.lights[0].scale);
  EXPECT_EQ(loadEdits(folder / "r.json").size(), recording.steps.size()) << "a recording is an edits file too";
  EXPECT_THROW(loadRecording(folder.write("n.json", R"({"edits": []})")), InputError);
  EXPECT_THROW(loadRecording(folder.write("v.json", R"({"recording": 2, "scene": ["a"], "edits": []})")), InputError);
  EXPECT_THROW(loadRecording(folder.write("s.json", R"({"recording": 1, "scene": [], "edits": []})")), InputError);
}

TEST(EditsFile, TheCabinsScriptApplies) {
  DELTALUX_SHARED_OR_SKIP(shared);
  Scene scene = loadScene({shared / "scenes/cabin/cabin.rad"}).scene;
  const auto steps = loadEdits(shared / "scenes/cabin/edits-container.json");
  EXPECT_EQ(steps.size(), 4u);
  EditHistory history;
  for (const EditStep& step : steps) EXPECT_FALSE(applyStep(scene, history, step).change.moved.empty());
  EXPECT_NO_THROW(validate(scene));
}

}  // namespace
}  // namespace deltalux
