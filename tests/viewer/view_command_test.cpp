// deltalux view by script, with a display that no screen shows: what it shows and reads against what the other commands
// make of the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <deltalux/image_io.hpp>
#include <deltalux/points.hpp>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using nlohmann::json;
using test::bundledScene;
using test::CliResult;
using test::runCli;
using test::TempFolder;

const std::string kScene = "cornell/cornell.rad";
const std::vector<std::string> kCoarse{"--error", "0.3"};
// On the floor in front of the blocks, and its number for a command line.
constexpr const char* kFloor = "0.3 0 0.06 0 1 0";

class ViewCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::hasDisplayServer()) GTEST_SKIP() << "no Xvfb here: scripts/install-deps";
  }

  std::vector<json> play(const std::string& script, const std::vector<std::string>& more = {},
                         const std::vector<std::string>& quality = kCoarse) {
    std::vector<std::string> arguments{"view",
                                       bundledScene(kScene),
                                       "--quiet",
                                       "--view",
                                       bundledScene("cornell/cornell.vf"),
                                       "--script",
                                       folder_.write("s.script", "size 64 64\n" + script)};
    arguments.insert(arguments.end(), quality.begin(), quality.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const CliResult result = test::runCliWithDisplay(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err << result.out;
    std::vector<json> entries;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) entries.push_back(json::parse(line));
    return entries;
  }

  static std::vector<double> readings(const std::vector<json>& entries) {
    std::vector<double> lux;
    for (const json& entry : entries)
      if (entry["action"] == "read" && entry.contains("probe")) lux.push_back(entry["lux"]);
    return lux;
  }

  /// What `deltalux probe` reads there after these edits.
  double probed(const std::string& edits) {
    const auto file = [&](const char* name) { return (folder_ / name).string(); };
    std::vector<std::string> solve{"solve", bundledScene(kScene), "-o", file("s.dlx"), "--quiet"};
    solve.insert(solve.end(), kCoarse.begin(), kCoarse.end());
    EXPECT_EQ(runCli(solve).exitCode, 0);
    if (!edits.empty()) {
      folder_.write("e.json", "{\"edits\": [" + edits + "]}");
      EXPECT_EQ(runCli({"update", file("s.dlx"), "--edits", file("e.json"), "-o", file("s.dlx"), "--quiet"}).exitCode,
                0);
    }
    folder_.write("p.csv", "x,y,z,nx,ny,nz\n0.3,0,0.06,0,1,0\n");
    EXPECT_EQ(runCli({"probe", file("s.dlx"), "--points", file("p.csv"), "-o", file("o.csv"), "--quiet"}).exitCode, 0);
    const PointTable table = readPoints(folder_ / "o.csv");
    const auto column = std::ranges::find(table.columns, "lux") - table.columns.begin();
    return std::stod(table.rows[0][static_cast<std::size_t>(column)]);
  }

  TempFolder folder_;
};

TEST_F(ViewCommand, AProbeReadsWhatProbeReads) {
  const auto entries = play(fmt::format("wait settled\nprobe floor {}\nread floor\n", kFloor));
  ASSERT_EQ(readings(entries).size(), 1u);
  const double lux = probed("");
  EXPECT_GT(lux, 20);
  EXPECT_NEAR(readings(entries)[0], lux, 0.02 * lux);
}

TEST_F(ViewCommand, ADragIsWhatAnUpdateMakesOfItAndUndoTakesItBack) {
  const auto entries =
      play(fmt::format(
               "wait settled\nprobe floor {}\nread floor\nselect short_block\ndrag 0 0 -0.05 frames 6\nwait settled\n"
               "read floor\nundo\nwait settled\nread floor\nredo\nwait settled\nread floor\n",
               kFloor),
           {"--record", folder_ / "session.json"});
  const std::vector<double> lux = readings(entries);
  ASSERT_EQ(lux.size(), 4u);
  const double moved = probed(R"({"op": "transform", "object": "short_block", "translate": [0, 0, -0.05]})");
  EXPECT_GT(std::abs(moved - lux[0]), 0.05 * lux[0]) << "the point has to see the block move";
  EXPECT_NEAR(lux[1], moved, 0.03 * moved);
  EXPECT_NEAR(lux[2], lux[0], 0.02 * lux[0]);
  EXPECT_NEAR(lux[3], lux[1], 0.02 * lux[1]);
  // One step a drag, and the record replays.
  const json record = json::parse(test::readText(folder_ / "session.json"));
  EXPECT_EQ(record["edits"].size(), 3u) << record.dump();
  const CliResult replayed = runCli({"replay", folder_ / "session.json"});
  EXPECT_EQ(replayed.exitCode, 0) << replayed.err;
}

TEST_F(ViewCommand, ALampDimsAndAStoredStateComesBack) {
  const auto entries = play(fmt::format(
      "wait settled\nprobe floor {}\nread floor\nstore A\n"
      "dim lamp 0.5 frames 4\nwait settled\nread floor\n"
      "compare A 0.5\nfalsecolour illuminance 2000\nscreenshot {}\ncompare off\nrestore A\nwait settled\nread floor\n",
      kFloor, (folder_ / "ab.png").string()));
  const std::vector<double> lux = readings(entries);
  ASSERT_EQ(lux.size(), 3u);
  EXPECT_NEAR(lux[1], 0.5 * lux[0], 0.01 * lux[0]);
  EXPECT_NEAR(lux[2], lux[0], 0.01 * lux[0]);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "ab.png"));
}

TEST_F(ViewCommand, StandingStillItShowsWhatRenderMakes) {
  const auto exr = [&](const char* name) { return (folder_ / name).string(); };
  play(fmt::format(
      "wait finished\nradiance {}\nselect short_block\ndrag 0 0 -0.05 frames 3\nwait finished\nradiance {}\n"
      "save {}\n",
      exr("a.exr"), exr("b.exr"), exr("s.dlx")));
  EXPECT_EQ(runCli({"render", exr("s.dlx"), "--view", bundledScene("cornell/cornell.vf"), "--size", "64x64", "-o",
                    exr("r.exr"), "--quiet"})
                .exitCode,
            0);
  const Image seen = loadImage(exr("b.exr")), rendered = loadImage(exr("r.exr")), before = loadImage(exr("a.exr"));
  ASSERT_EQ(seen.pixels.size(), rendered.pixels.size());
  double squares = 0, sum = 0, changed = 0;
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    const double a = gray(seen.pixels[i]), b = gray(rendered.pixels[i]);
    squares += (a - b) * (a - b), sum += b * b;
    changed += std::abs(a - gray(before.pixels[i])) > 0.1 * b;
  }
  EXPECT_LT(std::sqrt(squares / sum), 0.01);
  EXPECT_GT(changed, 50) << "the block moved";
}

TEST_F(ViewCommand, ThePointUnderTheCursorAndAFieldAreMeasured) {
  const auto entries =
      play("wait settled\npoint 32 60\nfield 0.32 0 0.02 0 0 0.1 0.2 0 0 3 3\nread field\nexplain 0.3 0 0.06 0 1 0\n");
  ASSERT_EQ(entries.size(), 4u);
  const json& point = entries[1];
  EXPECT_GT(point["lux"], 5);
  ASSERT_EQ(point["lamps_lux"].size(), 1u) << point.dump();
  const json& field = entries[2]["field"];
  EXPECT_GT(field["Emin"], 0);
  EXPECT_LE(field["Emin"], field["Em"]);
  EXPECT_NEAR(double(field["U0"]), double(field["Emin"]) / double(field["Em"]), 1e-6);
  const json& why = entries[3];
  double surfaces = 0;
  for (const auto& [name, lux] : why["surfaces_lux"].items()) surfaces += double(lux);
  EXPECT_GT(surfaces, 0.5 * double(why["indirect_lux"]));
  EXPECT_LT(surfaces, 1.01 * double(why["indirect_lux"]));
}

/// The colour that stands for an illuminance on a scale of three decades below `top`.
std::array<std::uint8_t, 3> falseColourOf(double lux, double top) {
  Image one;
  one.width = one.height = 1;
  one.pixels = {Rgb(static_cast<float>(lux / kLuminousEfficacy))};
  FalseColorSettings settings;
  settings.top = top;
  const DisplayImage shown = falseColor(one, settings);
  return shown.at(shown.width - 1, 0);
}

TEST_F(ViewCommand, FalseColourStandsForWhatAProbeReads) {
  const auto entries =
      play("wait settled\nfalsecolour illuminance 1000 log 3\npoint 30 25\npoint 6 40\n", {}, {"--error", "0.05"});
  ASSERT_EQ(entries.size(), 3u);
  for (const std::size_t i : {1, 2}) {
    const double lux = entries[i]["lux"];
    ASSERT_GT(lux, 1);
    // What is drawn is the mesh's light; the probe's is within some percent of it.
    int nearest = 1000;
    for (double share = 0.75; share < 1.34; share *= 1.01) {
      const auto wanted = falseColourOf(share * lux, 1000);
      int off = 0;
      for (std::size_t k = 0; k < 3; ++k) off = std::max(off, std::abs(int(wanted[k]) - int(entries[i]["colour"][k])));
      nearest = std::min(nearest, off);
    }
    EXPECT_LE(nearest, 4) << entries[i].dump();
    // And not just any colour of the scale.
    const auto other = falseColourOf(4 * lux, 1000);
    int apart = 0;
    for (std::size_t k = 0; k < 3; ++k) apart = std::max(apart, std::abs(int(other[k]) - int(entries[i]["colour"][k])));
    EXPECT_GT(apart, 16) << entries[i].dump();
  }
}

TEST_F(ViewCommand, AWrongScriptIsToldBeforeAnythingIsOpened) {
  const CliResult wrong = runCli({"view", bundledScene(kScene), "--script", folder_.write("w.script", "wait\n")});
  EXPECT_EQ(wrong.exitCode, 3);
  EXPECT_NE(wrong.err.find("w.script:1:"), std::string::npos) << wrong.err;
  const CliResult unknown = test::runCliWithDisplay({"view", bundledScene(kScene), "--error", "0.5", "--script",
                                                     folder_.write("u.script", "wait settled\nselect blok\n")});
  EXPECT_EQ(unknown.exitCode, 3);
  EXPECT_NE(unknown.err.find("u.script:2:"), std::string::npos) << unknown.err;
}

TEST(ViewCommandWithoutDisplay, SaysWhatDoesWithoutOne) {
  ::unsetenv("DISPLAY");
  ::unsetenv("WAYLAND_DISPLAY");
  const CliResult result = runCli({"view", bundledScene(kScene)});
  EXPECT_EQ(result.exitCode, 4);
  EXPECT_NE(result.err.find("no display"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("deltalux render"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace deltalux
