#include <gtest/gtest.h>

#include <deltalux/math.hpp>
#include <deltalux/points.hpp>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;
using test::TempFolder;
using Names = std::vector<std::string>;

double column(const PointTable& table, std::size_t row, const std::string& name) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i] == name) return std::stod(table.rows[row][i]);
  ADD_FAILURE() << "no column " << name;
  return 0;
}

std::string furnacePoints(const TempFolder& folder) {
  return folder.write("p.csv",
                      "# a wall, and the middle\nname,x,y,z,nx,ny,nz\nfloor,.3,0,.4,0,1,0\nair,.5,.4,.6,.6,0,.8\n");
}

TEST(ProbeCommand, MeasuresTheFurnaceOnWallsAndInTheAir) {
  const TempFolder folder;
  for (const Names& options : {Names{}, Names{"--mesh"}}) {
    Names arguments{"probe",    bundledScene("furnace/furnace.gltf"),
                    "--points", furnacePoints(folder),
                    "-o",       folder / "o.csv",
                    "--report", folder / "r.json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const auto result = runCli(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(result.out, "");
    const PointTable table = readPoints(folder / "o.csv");
    EXPECT_EQ(table.columns,
              (Names{"name", "x", "y", "z", "nx", "ny", "nz", "E_r", "E_g", "E_b", "lux", "se_r", "se_g", "se_b"}));
    for (std::size_t row = 0; row < 2; ++row) {
      EXPECT_NEAR(column(table, row, "E_g"), 2 * kPi, 0.03 * 2 * kPi) << row;
      EXPECT_NEAR(column(table, row, "E_g") * 179, column(table, row, "lux"), 0.01);
    }
  }
  const auto report = nlohmann::json::parse(test::readText(folder / "r.json"));
  EXPECT_EQ(report["command"], "probe");
  EXPECT_GT(report["counts"]["leaf_elements"], 0);
  EXPECT_GT(report["energy"]["emitted_w"], 0);
}

TEST(ProbeCommand, ThreadsDoNotDecide) {
  const TempFolder folder;
  const auto run = [&](const char* threads) {
    EXPECT_EQ(runCli({"probe", bundledScene("furnace/furnace.gltf"), "--points", furnacePoints(folder), "-o",
                      folder / "o.csv", "--threads", threads})
                  .exitCode,
              0);
    return test::readText(folder / "o.csv");
  };
  EXPECT_EQ(run("1"), run("2"));
}

TEST(ProbeCommand, ColumnsByLightAddUpToTheWhole) {
  const TempFolder folder;
  const std::string scene = bundledScene("cornell/cornell.rad"), solution = folder / "c.dlx";
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n.3,.3,0,0,0,1\n.45,.1,0,0,0,1\n");
  ASSERT_EQ(runCli({"solve", scene, "--error", "0.1", "--by-light", "-o", solution}).exitCode, 0);
  ASSERT_EQ(runCli({"probe", solution, "--points", points, "--by-light", "-o", folder / "a.csv"}).exitCode, 0);
  ASSERT_EQ(runCli({"probe", solution, "--points", points, "-o", folder / "e.csv"}).exitCode, 0);
  const PointTable columns = readPoints(folder / "a.csv"), whole = readPoints(folder / "e.csv");
  for (std::size_t row = 0; row < 2; ++row)
    EXPECT_NEAR(column(columns, row, "lux_lamp") / column(whole, row, "lux"), 1, 0.02);
}

TEST(ProbeCommand, ColumnsByLightWantASolutionThatHasThem) {
  const TempFolder folder;
  const std::string scene = bundledScene("cornell/cornell.rad"), solution = folder / "c.dlx";
  ASSERT_EQ(runCli({"solve", scene, "--error", "0.2", "-o", solution}).exitCode, 0);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n.3,.3,0,0,0,1\n");
  const auto refused = runCli({"probe", solution, "--points", points, "--by-light", "-o", folder / "a.csv"});
  EXPECT_EQ(refused.exitCode, 3);
  EXPECT_NE(refused.err.find("--by-light"), std::string::npos) << refused.err;
  EXPECT_EQ(runCli({"solve", scene, "--group", "lamp", "-o", solution}).exitCode, 2);
  EXPECT_EQ(runCli({"solve", scene, "--group", "x=no_such_lamp", "-o", solution}).exitCode, 2);
}

TEST(ProbeCommand, FailuresLeaveWhatStoodThere) {
  const TempFolder folder;
  const std::string scene = bundledScene("furnace/furnace.gltf"), out = folder.write("out.csv", "old");
  const std::string bad = folder.write("bad.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0\n");
  EXPECT_EQ(runCli({"probe", scene, "--points", bad, "-o", out}).exitCode, 3);
  EXPECT_EQ(runCli({"probe", folder / "none.gltf", "--points", furnacePoints(folder), "-o", out}).exitCode, 3);
  EXPECT_EQ(runCli({"probe", scene, "--points", furnacePoints(folder)}).exitCode, 2);
  EXPECT_EQ(runCli({"probe", scene, "-o", out}).exitCode, 2);
  EXPECT_EQ(runCli({"probe", scene, "--points", furnacePoints(folder), "-o", out, "--error", "1.5"}).exitCode, 2);
  EXPECT_EQ(runCli({"probe", scene, "--points", furnacePoints(folder), "-o", folder / "no/out.csv"}).exitCode, 4);
  EXPECT_EQ(test::readText(out), "old");
}

}  // namespace
}  // namespace deltalux
