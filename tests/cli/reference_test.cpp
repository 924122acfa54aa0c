#include <gtest/gtest.h>
#include <signal.h>

#include <deltalux/image_io.hpp>
#include <deltalux/points.hpp>
#include <deltalux/units.hpp>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::CliResult;
using test::runCli;
using test::TempFolder;
using Json = nlohmann::json;
using Names = std::vector<std::string>;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

double column(const PointTable& table, std::size_t row, const std::string& name) {
  for (std::size_t i = 0; i < table.columns.size(); ++i)
    if (table.columns[i] == name) return std::stod(table.rows[row][i]);
  ADD_FAILURE() << "no column " << name;
  return 0;
}

std::string furnacePoints(const TempFolder& folder) {
  return folder.write("p.csv", "# two walls\nwall,x,y,z,nx,ny,nz\nfloor,.3,0,.4,0,1,0\nside,1,.2,.7,-1,0,0\n");
}

TEST(ReferenceCommand, MistakesAreExitCodeTwo) {
  const std::string scene = bundledScene("cornell/cornell.rad"), view = bundledScene("cornell/cornell.vf");
  const std::vector<Names> wrong{
      {"reference", scene, "-o", "x.png"},                                       // neither points nor view
      {"reference", scene, "--view", view},                                      // no -o
      {"reference", scene, "--view", view, "--points", "p.csv", "-o", "x.png"},  // both
      {"reference", scene, "--view", view, "-o", "x.jpg"},                       // no such format
      {"reference", scene, "--view", view, "-o", "x.png", "--size", "0x10"},
      {"reference", scene, "--view", view, "-o", "x.png", "--size", "100"},
      {"reference", scene, "--view", view, "-o", "x.png", "--samples", "0"},
      {"reference", scene, "--view", view, "-o", "x.png", "--samples", "many"},
      {"reference", scene, "--view", view, "-o", "x.png", "--samples", "1", "--seconds", "1"},
      {"reference", scene, "--view", view, "-o", "x.png", "--seconds", "-1"},
      {"reference", scene, "--view", view, "-o", "x.png", "--threads", "0"},
      {"reference", scene, "--view", view, "-o", "x.png", "--seed", "-1"},
      {"reference", scene, "--view", view, "-o", "x.png", "--progress", "dots"},
      {"reference", scene, "--view", view, "-o", "x.png", "--tonemap", "magic"},
      {"reference", scene, "--view", view, "-o", "x.png", "--falsecolor", "cd"},
      {"reference", scene, "--view", view, "-o", "x.exr", "--falsecolor", "lux"},
      {"reference", scene, "--view", view, "-o", "x.exr", "--ev", "1"},  // changes nothing
      {"reference", scene, "--view", view, "-o", "x.hdr", "--tonemap", "linear"},
      {"reference", scene, "--points", "p.csv", "-o", "x.csv", "--size", "10x10"},
  };
  for (const Names& arguments : wrong) test::expectUsageError(arguments);
}

TEST(ReferenceCommand, ProbesTheFurnace) {
  const TempFolder folder;
  const std::string out = folder / "out.csv";
  const CliResult result = runCli({"reference", bundledScene("furnace/furnace.gltf"), "--points", furnacePoints(folder),
                                   "-o", out, "--samples", "4096", "--report", folder / "r.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, "");
  const PointTable table = readPoints(out);
  EXPECT_EQ(table.columns,
            (Names{"wall", "x", "y", "z", "nx", "ny", "nz", "E_r", "E_g", "E_b", "lux", "se_r", "se_g", "se_b"}));
  for (std::size_t row = 0; row < 2; ++row) {
    const double se = column(table, row, "se_g");
    EXPECT_LT(se, 0.1);
    EXPECT_NEAR(column(table, row, "E_g"), 2 * kPi, 5 * se + 1e-4);
    EXPECT_NEAR(column(table, row, "lux"), 179 * 2 * kPi, 5 * 179 * se + 0.1);
  }
  const Json report = Json::parse(test::readText(folder / "r.json"));
  EXPECT_EQ(report["command"], "reference");
  EXPECT_EQ(report["reference"]["paths"], 2 * 4096);
  EXPECT_GT(report["reference"]["rays"], report["reference"]["paths"]);
  EXPECT_EQ(folder.names(), (Names{"out.csv", "p.csv", "r.json"}));
}

TEST(ReferenceCommand, SeedsDecideAndThreadsDoNot) {
  const TempFolder folder;
  const auto run = [&](const Names& options) {
    Names arguments{"reference", bundledScene("cornell/cornell.rad"),
                    "--points",  folder.write("q.csv", "x,y,z,nx,ny,nz\n.3,0,.1,0,1,0\n.1,.3,.5592,0,0,-1\n"),
                    "-o",        folder / "o.csv",
                    "--samples", "64"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const CliResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return test::readText(folder / "o.csv");
  };
  const std::string one = run({"--threads", "1"});
  EXPECT_EQ(one, run({"--threads", "2"}));
  EXPECT_EQ(one, run({"--seed", "1"}));
  EXPECT_NE(one, run({"--seed", "2"}));
}

TEST(ReferenceCommand, RendersViewsInEveryFormat) {
  const TempFolder folder;
  const std::string scene = bundledScene("cornell/cornell.rad"), view = bundledScene("cornell/cornell.vf");
  for (const char* name : {"a.exr", "a.hdr", "a.png"}) {
    const CliResult result =
        runCli({"reference", scene, "--view", view, "-o", folder / name, "--samples", "4", "--size", "24x16"});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "16 x 16 pixels")) << result.err;  // the view is square
  }
  const Image exr = loadImage(folder / "a.exr"), hdr = loadImage(folder / "a.hdr");
  ASSERT_EQ(exr.width, 16);
  EXPECT_EQ(exr.view.substr(0, 30), "-vtv -vp 0.278 0.273 -0.8 -vd ");
  EXPECT_EQ(hdr.view, exr.view);
  double sum = 0;
  for (std::size_t i = 0; i < exr.pixels.size(); ++i) {
    EXPECT_NEAR(hdr.pixels[i].g, exr.pixels[i].g, 0.02 * maxChannel(exr.pixels[i]));
    sum += exr.pixels[i].g;
  }
  EXPECT_GT(sum, 0);
  EXPECT_EQ(folder.names(), (Names{"a.exr", "a.hdr", "a.png"}));
}

TEST(ReferenceCommand, ShowsFalseColourWithALegend) {
  const TempFolder folder;
  const CliResult result =
      runCli({"reference", bundledScene("cornell/cornell.rad"), "--view", bundledScene("cornell/cornell.vf"), "-o",
              folder / "a.png", "--samples", "4", "--size", "32x32", "--falsecolor", "lux"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(folder.names(), Names{"a.png"});
}

TEST(ReferenceCommand, FindsCamerasByNameAndSuggestsNearOnes) {
  const TempFolder folder;
  const std::string scene = bundledScene("furnace/furnace.gltf");
  EXPECT_EQ(runCli({"reference", scene, "--view", "inside", "-o", folder / "a.exr", "--samples", "1", "--size", "4x4"})
                .exitCode,
            0);
  const CliResult wrong = runCli({"reference", scene, "--view", "insied", "-o", folder / "b.exr"});
  EXPECT_EQ(wrong.exitCode, 3);
  EXPECT_TRUE(contains(wrong.err, "'insied'") && contains(wrong.err, "inside")) << wrong.err;
  EXPECT_EQ(folder.names(), Names{"a.exr"});
}

TEST(ReferenceCommand, FailuresLeaveWhatStoodThere) {
  const TempFolder folder;
  const std::string scene = bundledScene("furnace/furnace.gltf"), out = folder.write("out.csv", "old");
  const std::string bad = folder.write("bad.csv", "x,y,z,nx,ny,nz\n1,2,3,0,0\n");
  const CliResult result = runCli({"reference", scene, "--points", bad, "-o", out});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_TRUE(contains(result.err, bad + ":2: ")) << result.err;
  EXPECT_EQ(runCli({"reference", scene, "--points", folder / "none.csv", "-o", out}).exitCode, 3);
  EXPECT_EQ(runCli({"reference", folder / "none.gltf", "--points", furnacePoints(folder), "-o", out}).exitCode, 3);
  EXPECT_EQ(test::readText(out), "old");
  EXPECT_EQ(runCli({"reference", scene, "--points", furnacePoints(folder), "-o", folder / "no/out.csv"}).exitCode, 4);
  EXPECT_EQ(runCli({"reference", scene, "--points", furnacePoints(folder), "-o", folder.path()}).exitCode, 4);
  EXPECT_EQ(folder.names(), (Names{"bad.csv", "out.csv", "p.csv"}));
}

TEST(ReferenceCommand, ProgressAsJsonLines) {
  const TempFolder folder;
  const CliResult result = runCli({"reference", bundledScene("furnace/furnace.gltf"), "--points", furnacePoints(folder),
                                   "-o", folder / "out.csv", "--samples", "20000", "--progress", "json", "--quiet"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  std::istringstream lines(result.out);
  double last = -1;
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const Json json = Json::parse(line);
    EXPECT_FALSE(json["phase"].get<std::string>().empty());
    EXPECT_GE(json["fraction"].get<double>(), last);
    EXPECT_GE(json["elapsed_s"].get<double>(), 0);
    last = json["fraction"];
  }
  EXPECT_GE(count, 2);
  EXPECT_EQ(last, 1.0);
}

TEST(ReferenceCommand, InterruptsAreExitCode130AndWriteNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TempFolder folder;
    const std::string out = folder.write("out.csv", "old"), points = furnacePoints(folder);
    const CliResult result = runCli({"reference", bundledScene("furnace/furnace.gltf"), "--points", points, "-o", out,
                                     "--seconds", "60", "--progress", "json", "--report", folder / "r.json"},
                                    [&](int pid) { ::kill(pid, signal); });
    EXPECT_EQ(result.exitCode, 130);
    EXPECT_TRUE(contains(result.err, "interrupted")) << result.err;
    EXPECT_EQ(test::readText(out), "old");
    EXPECT_EQ(folder.names(), (Names{"out.csv", "p.csv"}));
  }
}

TEST(ReferenceCommand, SecondsAreKept) {
  const TempFolder folder;
  const std::string points = furnacePoints(folder);
  for (const Names& what : {Names{"--points", points, "-o", folder / "out.csv"},
                            Names{"--view", "inside", "--size", "300x300", "-o", folder / "out.exr"}}) {
    Names arguments{"reference",      bundledScene("furnace/furnace.gltf"), "--seconds", "0.5", "--report",
                    folder / "r.json"};
    arguments.insert(arguments.end(), what.begin(), what.end());
    const CliResult result = runCli(arguments);
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const Json report = Json::parse(test::readText(folder / "r.json"));
    EXPECT_GT(report["time_s"]["total"], 0.2);
    EXPECT_LT(report["time_s"]["total"], 5.0);
  }
}

TEST(ReferenceCommand, DiffuseOnlyTakesTheMirrorOut) {
  const TempFolder folder;
  // On the floor before the mirror block, where its reflection of the lamp adds light.
  const std::string points = folder.write("q.csv", "x,y,z,nx,ny,nz\n.36,0,.12,0,1,0\n");
  const auto irradiance = [&](const Names& options) {
    Names arguments{"reference", bundledScene("cornell-caustic/cornell-caustic.rad"),
                    "--points",  points,
                    "-o",        folder / "o.csv",
                    "--samples", "20000"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    EXPECT_EQ(runCli(arguments).exitCode, 0);
    const PointTable table = readPoints(folder / "o.csv");
    return std::pair(column(table, 0, "E_g"), column(table, 0, "se_g"));
  };
  const auto [full, fullError] = irradiance({});
  const auto [diffuse, diffuseError] = irradiance({"--diffuse-only"});
  EXPECT_GT(full, diffuse + 3 * (fullError + diffuseError));
}

}  // namespace
}  // namespace deltalux
