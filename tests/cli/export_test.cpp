#include <gtest/gtest.h>

#include "export/page_support.hpp"
#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::expectUsageError;
using test::runCli;
using test::TempFolder;

const std::string kScene = "furnace/furnace.gltf";

TEST(ExportCommand, WritesAPageWithItsGrids) {
  const test::TempFolder folder;
  folder.write("p.csv", "x,y,z,nx,ny,nz,grid\n0,0,0,0,0,1,desk\n0.1,0,0,0,0,1,floor\n0.2,0,0,0,0,1,desk\n");
  const auto result = runCli({"export", bundledScene(kScene), "-o", folder / "page.html", "--points", folder / "p.csv",
                              "--title", "The furnace", "--ev", "-1"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const test::Payload page = test::payloadOfPage(test::readText(folder / "page.html"));
  EXPECT_EQ(page.header["title"], "The furnace");
  EXPECT_EQ(page.header["ev"], -1);
  EXPECT_EQ(page.header["views"][0]["name"], "inside");
  ASSERT_EQ(page.header["points"]["grids"].size(), 2u);
  EXPECT_EQ(page.header["points"]["grids"][0]["points"].size(), 2u);
}

TEST(ExportCommand, MistakesAreToldBeforeSolving) {
  const test::TempFolder folder;
  test::expectUsageError({"export", bundledScene(kScene), "-o", folder / "page.pdf"});
  EXPECT_EQ(runCli({"export", bundledScene(kScene), "-o", folder / "none/page.html"}).exitCode, 4);
  EXPECT_EQ(runCli({"export", bundledScene(kScene), "-o", folder / "page.html", "--points", folder / "p.csv"}).exitCode,
            3);
  EXPECT_EQ(runCli({"export", bundledScene(kScene), "-o", folder / "page.html", "--view", "insied"}).exitCode, 3);
  EXPECT_TRUE(folder.names().empty());
}

TEST(ExportCommand, WritesGeometryAndLightAndSaysSo) {
  const TempFolder folder;
  const auto result =
      runCli({"export", bundledScene("furnace/furnace.gltf"), "-o", folder / "f.glb", "--error", "0.1"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("f.lightmap.exr"), std::string::npos) << result.err;
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"f.glb", "f.lightmap.exr"}));
}

TEST(ExportCommand, SaysWhichExposureItChose) {
  const TempFolder folder;
  const auto result =
      runCli({"export", bundledScene("furnace/furnace.gltf"), "-o", folder / "f.glb", "--error", "0.1", "--unlit"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("--ev"), std::string::npos) << result.err;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"f.glb"});
}

TEST(ExportCommand, RefusesWhatItCannotWrite) {
  const TempFolder folder;
  const std::string scene = bundledScene("furnace/furnace.gltf");
  expectUsageError({"export", scene, "-o", folder / "f.fbx"});
  expectUsageError({"export", scene, "-o", folder / "f.glb", "--ev", "2"});
  expectUsageError({"export", scene, "-o", folder / "f.glb", "--unlit", "--by-light"});
  expectUsageError({"export", scene, "-o", folder / "f.glb", "--atlas-size", "10"});
  expectUsageError({"export", scene, "-o", folder / "f.glb", "--title", "A page's"});
  expectUsageError({"export", scene, "-o", folder / "f.html", "--meshopt"});
  EXPECT_EQ(runCli({"export", scene, "-o", folder / "none" / "f.glb"}).exitCode, 4);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace deltalux
