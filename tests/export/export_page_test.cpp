// A page read back: the light that it shows is the solution's.
#include <gtest/gtest.h>

#include <deltalux/export.hpp>
#include <deltalux/light_groups.hpp>
#include <deltalux/solution_reader.hpp>

#include "export/page_support.hpp"
#include "export/page_template.hpp"
#include "support/solution_scenes.hpp"
#include "support/solved.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

Engine everything() {
  Engine engine(test::oneOfEverything(), test::coarse());
  engine.solve();
  return engine;
}

TEST(ExportPage, HoldsTheSolution) {
  const Engine engine = everything();
  const test::TempFolder folder;
  PageSettings settings;
  settings.title = "a <room> & \"more\"";
  settings.views.push_back({"from the door", View::Kind::Perspective, {1.5, 0.3, 1.2}, {0, 1, 0}, {0, 0, 1}, 60, 45});
  settings.grids.push_back({"table", {{{1.5, 1, 1}, {0, 0, 1}}, {{1.0, 1.2, 1}, {0, 0, 1}}}});
  settings.meterError = 0.05;
  exportPage(engine.solution(), folder / "page.html", settings);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"page.html"});
  const test::Payload page = test::payloadOfPage(test::readText(folder / "page.html"));
  EXPECT_EQ(page.header["title"], settings.title);
  EXPECT_EQ(page.header["groups"].size(), lightGroups(engine.solution()).size());
  EXPECT_EQ(page.header["views"].size(), 1u);  // the scene's own is parallel
  const std::size_t vertices = page.header["vertexCount"];
  EXPECT_EQ(page.section("layer0").size(), 5 * vertices);
  EXPECT_EQ(page.section("positions").size(), 12 * vertices);
  EXPECT_EQ(page.section("triangles").size(), 4 * page.header["indexCount"].get<std::size_t>());
}

TEST(ExportPage, GridsAreReadAsProbeReads) {
  const Engine engine = everything();
  const test::TempFolder folder;
  PageSettings settings;
  settings.grids = {{"a", {{{1.5, 1, 1}, {0, 0, 1}}}}, {"b", {{{1.0, 1.2, 1}, {0, 0, 1}}}}};
  settings.meterError = 0.01;
  exportPage(engine.solution(), folder / "page.html", settings);
  const test::Payload page = test::payloadOfPage(test::readText(folder / "page.html"));
  const std::vector<float> light = page.array<float>("points.light");
  const std::size_t groups = page.header["groups"].size();
  ASSERT_EQ(light.size(), groups * 2 * 3);
  ProbeSettings probing;
  probing.error = 0.01, probing.seed = 7;
  const std::vector<ProbeResult> expected = probe(
      engine.solution(), std::vector<ProbePoint>{settings.grids[0].points[0], settings.grids[1].points[0]}, probing);
  for (std::size_t i = 0; i < 2; ++i) {
    double sum = 0;
    for (std::size_t g = 0; g < groups; ++g)
      for (std::size_t c = 0; c < 3; ++c)
        sum += double(light[3 * (2 * g + i) + c]) * double(page.header["groups"][g]["weight"][c]) *
               kLuminanceWeights[int(c)];
    EXPECT_NEAR(sum, gray(expected[i].irradiance), 0.05 * gray(expected[i].irradiance));
  }
}

TEST(ExportPage, GivesTheSameBytesTwice) {
  const Engine engine = everything();
  const test::TempFolder folder;
  exportPage(engine.solution(), folder / "a.html");
  exportPage(engine.solution(), folder / "b.html");
  EXPECT_EQ(test::readText(folder / "a.html"), test::readText(folder / "b.html"));
}

TEST(ExportPage, TheTemplateAsksNobodyForAnything) {
  const std::string page(exporting::pageTemplate());
  EXPECT_NE(page.find("MIT License"), std::string::npos);
  EXPECT_NE(page.find("three.js authors"), std::string::npos);
  for (const char* place : {"@DELTALUX_SOLUTION@", "@DELTALUX_LATER@"}) {
    EXPECT_NE(page.find(place), std::string::npos);
    EXPECT_EQ(page.find(place), page.rfind(place));
  }
  for (const char* from : {"src=\"http", "href=\"http", "src=\"./", "href=\"./", "import(\"http"})
    EXPECT_EQ(page.find(from), std::string::npos) << from;
}

}  // namespace
}  // namespace deltalux
