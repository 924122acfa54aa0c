#include <gtest/gtest.h>

#include <deltalux/points.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::expectUsageError;
using test::runCli;
using test::TempFolder;

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
  EXPECT_EQ(runCli({"export", scene, "-o", folder / "none" / "f.glb"}).exitCode, 4);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace deltalux
