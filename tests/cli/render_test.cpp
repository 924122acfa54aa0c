#include <gtest/gtest.h>

#include <deltalux/image_io.hpp>
#include <deltalux/math.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;
using test::TempFolder;
using Names = std::vector<std::string>;

const std::string kScene = "furnace/furnace.gltf";

TEST(RenderCommand, ShowsTheFurnaceInEveryFormat) {
  // Every wall emits 1 W/(sr m2) and reflects half of E = 2 pi: 2 W/(sr m2) wherever one looks.
  const TempFolder folder;
  for (const char* name : {"a.exr", "a.hdr", "a.png"}) {
    const auto result = runCli(
        {"render", bundledScene(kScene), "--view", "inside", "-o", folder / name, "--size", "24x16", "--samples", "4"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
  }
  const Image exr = loadImage(folder / "a.exr");
  EXPECT_EQ(exr.view.substr(0, 4), "-vtv");
  double sum = 0;
  for (const Rgb& L : exr.pixels) sum += L.g;
  EXPECT_NEAR(sum / static_cast<double>(exr.pixels.size()), 2, 0.1);
  EXPECT_EQ(folder.names(), (Names{"a.exr", "a.hdr", "a.png"}));
}

TEST(RenderCommand, ShowsTheMeshAndItsLinks) {
  const TempFolder folder;
  const Names base{"render", bundledScene(kScene), "--view", "inside", "--size", "48x48", "-o"};
  const auto run = [&](const char* name, const Names& options) {
    Names arguments = base;
    arguments.push_back(folder / name);
    arguments.insert(arguments.end(), options.begin(), options.end());
    return runCli(arguments).exitCode;
  };
  EXPECT_EQ(run("mesh.exr", {"--mesh", "--method", "paper"}), 0);
  EXPECT_EQ(run("links.exr", {"--mesh", "--method", "paper", "--links-of", "20,20"}), 0);
  EXPECT_EQ(run("soft.exr", {"--mesh-direct"}), 0);
  EXPECT_EQ(run("lux.png", {"--falsecolor", "lux"}), 0);
  EXPECT_NE(loadImage(folder / "mesh.exr").pixels, loadImage(folder / "links.exr").pixels);
  EXPECT_EQ(run("no.exr", {"--mesh", "--links-of", "99,20"}), 2);
  EXPECT_EQ(run("no.exr", {"--links-of", "9,20"}), 2);
  EXPECT_EQ(run("no.exr", {"--mesh", "--samples", "2"}), 2);
  EXPECT_EQ(folder.names(), (Names{"links.exr", "lux.png", "mesh.exr", "soft.exr"}));
}

TEST(RenderCommand, AMistakenViewIsToldBeforeSolving) {
  const TempFolder folder;
  const auto wrong = runCli({"render", bundledScene(kScene), "--view", "insied", "-o", folder / "b.exr"});
  EXPECT_EQ(wrong.exitCode, 3);
  EXPECT_NE(wrong.err.find("inside"), std::string::npos) << wrong.err;
  EXPECT_EQ(runCli({"render", bundledScene(kScene), "--view", "inside", "-o", folder / "b.jpeg"}).exitCode, 2);
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace deltalux
