#include <deltalux/sheet.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>

#include "support/run_cli.hpp"
#include "support/solved.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

/// The line and message that reading the text ends with.
std::pair<int, std::string> mistake(const std::string& text) {
  try {
    parseSheetRequest(text, "a.json");
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "a.json");
    return {error.line(), error.message()};
  }
  ADD_FAILURE() << "no mistake found";
  return {};
}

std::string areaWith(const std::string& members) {
  return "{\n  \"areas\": [\n    {\n      \"name\": \"desk\",\n" + members + "\n    }\n  ]\n}\n";
}

TEST(SheetRequest, MistakesHaveTheirLine) {
  EXPECT_EQ(mistake("{\n\"areas\": [\n}").first, 3);
  EXPECT_EQ(mistake(areaWith("\"surface\": \"top\",\n\"heigth\": 1")).first, 3);
  EXPECT_NE(mistake(areaWith("\"surface\": \"top\",\n\"heigth\": 1")).second.find("height"), std::string::npos);
  EXPECT_EQ(mistake(areaWith("\"surface\": \"top\",\n\"height\": \"high\"")).first, 6);
  EXPECT_EQ(mistake(areaWith("\"surface\": \"top\",\n\n\"height\": -1")).first, 7);
  EXPECT_EQ(mistake(areaWith("\"surface\": \"a } { \\\" [\",\n\"required\": {\"Em\": 1,\n\"U0\": 2}")).first, 7);
  EXPECT_EQ(mistake(areaWith("\"kind\": \"ofice\", \"surface\": \"top\"")).first, 5);
  EXPECT_NE(mistake(areaWith("\"kind\": \"ofice\", \"surface\": \"top\"")).second.find("office"), std::string::npos);
  EXPECT_EQ(mistake(areaWith("\"height\": 1")).first, 3);
  EXPECT_EQ(mistake(areaWith("\"rectangle\":\n{\"corner\": [0,0,0],\n\"u\": [1,0,0],\n\"v\": [1,1,0]}")).first, 5);
  EXPECT_EQ(mistake(areaWith("\"rectangle\": {\"corner\": [0,0,0],\n\"u\": [1,0],\n\"v\": [1,1,0]}")).first, 6);
  EXPECT_EQ(mistake(areaWith("\"polygon\": [[0,0,0],\n[1,0,0],\n[2,0,0]]")).first, 5);
  EXPECT_EQ(mistake("{\"areas\": []}").first, 1);
  EXPECT_EQ(mistake("{}").first, 1);
}

TEST(SheetRequest, KindsAskForWhatTheStandardDoesAndRequiredHasTheLastWord) {
  const SheetRequest request = parseSheetRequest(
      areaWith("\"kind\": \"office\", \"surface\": \"top\", \"required\": {\"Em\": 300, \"cylindrical\": null}"),
      "a.json");
  const AreaRequirements& r = request.areas.at(0).required;
  EXPECT_EQ(r.mean, 300);
  EXPECT_EQ(r.uniformity, 0.6);
  EXPECT_EQ(r.glare, 19);
  EXPECT_FALSE(r.cylindrical);
  EXPECT_EQ(r.walls, 150);
}

TEST(LuminaireTypes, HaveTheirFluxInAnyUnit) {
  const test::TempFolder folder;
  folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.3 0.3 0\n1 1 10\n0 45 90\n0\n100 100 100\n");
  Scene scene;
  scene.metresPerUnit = 0.01;
  for (int i = 0; i < 3; ++i) addLuminaire(scene, {folder / "lamp.ies", Vec3(100 * i, 0, 250)});
  PointLight bulb;
  bulb.intensity = test::fromPhotometric(10 / (0.01 * 0.01));  // 10 cd
  scene.lights.push_back({"bulb", bulb, Rgb(0.5f)});
  const auto types = luminaireTypes(scene, {{"bulb", "Bulb A", 7.0}});
  ASSERT_EQ(types.size(), 2u);
  EXPECT_EQ(types[0].name, "lamp");
  EXPECT_EQ(types[0].count, 3);
  EXPECT_NEAR(types[0].flux, luminousFlux(*types[0].photometry), 1e-3 * types[0].flux);
  EXPECT_EQ(types[1].name, "Bulb A");
  EXPECT_NEAR(types[1].flux, 20 * kPi, 0.01);
  EXPECT_EQ(types[1].watts, 7.0);
}

/// In a furnace, irradiance is 2 pi everywhere and in every direction.
Sheet furnaceSheet(double mean, double factor) {
  static const Engine engine = test::solved(loadScene({test::bundledScene("furnace/furnace.gltf")}).scene, 0.1);
  SheetRequest request = parseSheetRequest(
      areaWith("\"rectangle\": {\"corner\": [0.3,0.3,0.3], \"u\": [0.4,0,0], \"v\": [0,-0.2,0]},\n\"border\": 0, "
               "\"spacing\": 0.2, \"eye_height\": 0.1, \"required\": {\"U0\": 0.9, \"cylindrical\": 10}"),
      "a.json");
  request.areas[0].required.mean = mean, request.maintenanceFactor = factor;
  SheetSettings settings;
  settings.probe.error = 0.02, settings.probe.maxSamples = 1 << 10;
  return measureSheet(engine.solution(), request, "furnace.gltf", settings);
}

TEST(Sheet, MeasuresAndRates) {
  const double lux = 2 * kPi * kLuminousEfficacy;
  const Sheet sheet = furnaceSheet(0.9 * lux, 1);
  const MeasuredArea& area = sheet.areas.at(0);
  EXPECT_TRUE(area.passes());
  EXPECT_EQ(area.lux.size(), 2u);
  EXPECT_EQ(area.covered, 0u);
  for (const SheetRow& row : area.rows) {
    if (row.unit == "lx") {
      EXPECT_NEAR(row.reached, lux, 0.02 * lux) << row.quantity;
    } else {
      EXPECT_GT(row.reached, 0.95) << row.quantity;
    }
  }
  const Sheet dim = furnaceSheet(0.9 * lux, 0.8);
  EXPECT_FALSE(dim.areas[0].passes());
  EXPECT_NEAR(dim.areas[0].rows[0].reached, 0.8 * lux, 0.02 * lux);
}

TEST(Sheet, IsWrittenWhole) {
  Sheet sheet = furnaceSheet(5000, 1);
  sheet.request.title = "A <b> & c";
  sheet.request.areas[0].name = "desk";
  const test::TempFolder folder;
  saveSheet(folder / "s.html", sheet);
  const std::string html = test::readText(folder / "s.html");
  EXPECT_NE(html.find("A &lt;b&gt; &amp; c"), std::string::npos);
  EXPECT_NE(html.find(">FAIL<"), std::string::npos);
  EXPECT_NE(html.find("</html>"), std::string::npos);
  if (!canWritePdf()) {
    EXPECT_THROW(saveSheet(folder / "s.pdf", sheet), OutputError);
    return;
  }
  saveSheet(folder / "s.pdf", sheet);
  const std::string pdf = test::readText(folder / "s.pdf");
  EXPECT_TRUE(pdf.starts_with("%PDF"));
  EXPECT_NE(pdf.find("%%EOF"), std::string::npos);
  EXPECT_THROW(saveSheet(folder / "none/s.pdf", sheet), OutputError);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"s.html", "s.pdf"}));
}

}  // namespace
}  // namespace deltalux
