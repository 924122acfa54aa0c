#include <gtest/gtest.h>

#include <cstdio>
#include <deltalux/image_io.hpp>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;
using test::TempFolder;

TEST(GlareCommand, SeesALampAndWritesPicturesAndJson) {
  const TempFolder folder;
  // A hall whose walls glow, of 40 cd/m2, with a lamp of 4000 cd/m2.
  folder.write("hall.rad",
               "void glow wall\n0\n0\n4 .2234637 .2234637 .2234637 0\n"
               "wall bubble walls\n0\n0\n4 0 0 0 50\n"
               "void light lamp_light\n0\n0\n3 22.34637 22.34637 22.34637\n"
               "lamp_light polygon lamp\n0\n0\n12 -.3 2.3 2.7  -.3 2.9 2.7  .3 2.9 2.7  .3 2.3 2.7\n");
  const auto result =
      runCli({"glare", folder / "hall.rad", "--error", "0.1", "--eye", "0,0,1.2", "--towards", "0,5,1.2", "--size",
              "128", "--samples", "4", "-o", folder / "glare.exr", "--json", folder / "glare.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto json = nlohmann::json::parse(test::readText(folder / "glare.json"));
  double luminance = 0;
  for (const auto& l : json["ugr"][0]["luminaires"])
    if (l["name"] == "lamp") luminance = l["luminance_cd_m2"];
  EXPECT_NEAR(luminance, 4000, 8);
  EXPECT_NE(result.out.find("DGP "), std::string::npos) << result.out;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"glare.exr", "glare.json", "glare.marks.png", "hall.rad"}));
  const Image image = loadImage(folder / "glare.exr");
  EXPECT_EQ(image.width, 128);
  EXPECT_EQ(image.view.substr(0, 4), "-vta");
}

TEST(GlareCommand, FindsTheWorstPlaceOfAGrid) {
  const TempFolder folder;
  const auto result =
      runCli({"glare", bundledScene("cornell/cornell.rad"), "--error", "0.2", "--surface", "floor", "--spacing", "0.2",
              "--eye-height", "0.2", "--directions", "4", "--json", folder / "all.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("directions: UGR at most"), std::string::npos) << result.out;
  const auto json = nlohmann::json::parse(test::readText(folder / "all.json"));
  EXPECT_TRUE(json["dgp"].is_null());
  EXPECT_EQ(json["ugr"].size() % 4, 0u);
}

TEST(GlareCommand, MistakesAreToldBeforeSolving) {
  const std::string scene = bundledScene("cornell/cornell.rad");
  const TempFolder folder;
  test::expectUsageError({"glare", scene});
  test::expectUsageError({"glare", scene, "--eye", "1,1,1"});
  test::expectUsageError({"glare", scene, "--eye", "1,1,1", "--towards", "1,1,1"});
  test::expectUsageError({"glare", scene, "--eye", "1,1", "--towards", "1,1,1"});
  test::expectUsageError({"glare", scene, "--eye", "1,1,1", "--towards", "1,2,1", "--surface", "floor"});
  test::expectUsageError({"glare", scene, "--surface", "floor", "-o", folder / "glare.png"});
  test::expectUsageError({"glare", scene, "--eye", "1,1,1", "--towards", "1,2,1", "-o", folder / "glare.jpg"});
  const auto result = runCli({"glare", scene, "--surface", "flor"});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_NE(result.err.find("floor"), std::string::npos) << result.err;
  EXPECT_EQ(runCli({"glare", scene, "--view", "nowhere"}).exitCode, 3);
  EXPECT_EQ(runCli({"glare", scene, "--eye", "1,1,1", "--towards", "1,2,1", "--json", folder / "none/g.json"}).exitCode,
            4);
}

}  // namespace
}  // namespace deltalux
