#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::readText;
using test::runCli;
using test::TempFolder;
using Names = std::vector<std::string>;

std::string solvedFurnace(const TempFolder& folder) {
  const auto result = runCli({"solve", bundledScene("furnace/furnace.gltf"), "-o", folder / "f.dlx", "--report",
                              folder / "r.json", "--error", "0.1"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, "");
  return folder / "f.dlx";
}

TEST(SolveCommand, WhatItKeepsIsProbedAsIfSolvedNow) {
  const TempFolder folder;
  const std::string solution = solvedFurnace(folder);
  const auto report = nlohmann::json::parse(readText(folder / "r.json"));
  EXPECT_EQ(report["command"], "solve");
  EXPECT_GT(report["counts"]["lines"], 0);
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n.3,0,.4,0,1,0\n.5,.4,.6,.6,0,.8\n");
  EXPECT_EQ(runCli({"probe", solution, "--points", points, "-o", folder / "kept.csv", "--report", folder / "k.json"})
                .exitCode,
            0);
  EXPECT_EQ(runCli({"probe", bundledScene("furnace/furnace.gltf"), "--error", "0.1", "--points", points, "-o",
                    folder / "anew.csv"})
                .exitCode,
            0);
  EXPECT_EQ(readText(folder / "kept.csv"), readText(folder / "anew.csv"));
  const auto kept = nlohmann::json::parse(readText(folder / "k.json"));
  EXPECT_EQ(kept["counts"]["lines"], report["counts"]["lines"]);
  EXPECT_EQ(kept["scene_stats"]["primitives"], report["scene_stats"]["primitives"]);
  EXPECT_EQ(kept["time_s"]["refine"], 0) << "nothing was refined in this run";
}

TEST(SolveCommand, ASolutionIsRenderedThroughItsOwnViews) {
  const TempFolder folder;
  const std::string solution = solvedFurnace(folder);
  const auto wrong = runCli({"render", solution, "--view", "nowhere", "-o", folder / "v.png"});
  EXPECT_EQ(wrong.exitCode, 3);
  const std::string name = wrong.err.substr(wrong.err.find("scene: ") + 7);
  const std::string view = name.substr(0, name.find_first_of(",;)"));
  const auto result =
      runCli({"render", solution, "--view", view, "-o", folder / "v.png", "--size", "16x16", "--samples", "1"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "v.png"));
}

TEST(SolveCommand, MistakesAreToldApart) {
  const TempFolder folder;
  const std::string solution = solvedFurnace(folder), scene = bundledScene("furnace/furnace.gltf");
  test::expectUsageError({"solve", scene});
  test::expectUsageError({"solve", scene, "-o", folder / "f.txt"});
  test::expectUsageError({"solve", scene, "-o", folder / "g.dlx", "--error", "2"});
  test::expectUsageError({"solve", scene, "-o", folder / "g.dlx", "--seconds", "-1"});
  test::expectUsageError({"solve", scene, "-o", folder / "g.dlx", "--method", "links"});
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n.3,0,.4,0,1,0\n");
  test::expectUsageError({"probe", solution, "--points", points, "-o", folder / "o.csv", "--error", "0.2"});
  test::expectUsageError({"probe", solution, "--points", points, "-o", folder / "o.csv", "--diffuse-only"});
  EXPECT_EQ(runCli({"solve", folder / "none.rad", "-o", folder / "g.dlx"}).exitCode, 3);
  EXPECT_EQ(runCli({"solve", solution, "-o", folder / "g.dlx"}).exitCode, 3);
  EXPECT_EQ(runCli({"solve", scene, "-o", folder / "none/g.dlx"}).exitCode, 4);
  const std::string whole = readText(solution), damaged = folder.write("d.dlx", whole.substr(0, whole.size() / 2));
  const auto refused = runCli({"probe", damaged, "--points", points, "-o", folder / "o.csv"});
  EXPECT_EQ(refused.exitCode, 3);
  EXPECT_NE(refused.err.find("truncated"), std::string::npos) << refused.err;
  EXPECT_EQ(folder.names(), (Names{"d.dlx", "f.dlx", "p.csv", "r.json"}));
}

TEST(SolveCommand, AnInterruptLeavesWhatStoodThere) {
  const TempFolder folder;
  folder.write("l.dlx", "old");
  const auto result = runCli({"solve", bundledScene("lodge/morning.rad"), "-o", folder / "l.dlx", "--progress", "json"},
                             [](int pid) { ::kill(pid, SIGINT); });
  EXPECT_EQ(result.exitCode, 130) << result.err;
  EXPECT_EQ(readText(folder / "l.dlx"), "old");
  EXPECT_EQ(folder.names(), Names{"l.dlx"});
}

TEST(SolveCommand, TimeLimitEndsWithASolution) {
  const TempFolder folder;
  const auto result = runCli(
      {"solve", bundledScene("cornell/cornell.rad"), "-o", folder / "c.dlx", "--error", "0.0005", "--seconds", "0.05"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("time was up"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(folder / "c.dlx"));
}

}  // namespace
}  // namespace deltalux
