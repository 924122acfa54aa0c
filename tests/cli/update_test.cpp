// deltalux update and replay, from files to files.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::readText;
using test::runCli;
using test::TempFolder;

const std::string kEdits = R"({"edits": [
  {"op": "transform", "object": "short_block", "translate": [0.02, 0, -0.03]},
  {"op": "undo"},
  {"op": "transform", "object": "short_block", "translate": [-0.02, 0, 0.03]}
]})";

TEST(UpdateCommand, ReplayMeasuresEachEditAndChecksTheLast) {
  const TempFolder folder;
  folder.write("e.json", kEdits);
  const auto result = runCli({"replay", bundledScene("cornell/cornell.rad"), "--edits", folder / "e.json", "--check",
                              "--report", folder / "r.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto report = nlohmann::json::parse(readText(folder / "r.json"));
  ASSERT_EQ(report["steps"].size(), 3u);
  EXPECT_EQ(report["steps"][0]["op"], "transform");
  EXPECT_EQ(report["steps"][0]["object"], "short_block");
  EXPECT_GT(report["steps"][0]["leaves_changed"], 0);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["median"], 0.005);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["p95"], 0.03);
  EXPECT_EQ(report["check"]["particles_identical"], true);
}

/// A row for each edit, and one for the settling.
TEST(UpdateCommand, ADragIsSettledAtItsEnd) {
  const TempFolder folder;
  folder.write("e.json", kEdits);
  const auto result = runCli({"replay", bundledScene("cornell/cornell.rad"), "--edits", folder / "e.json", "--check",
                              "--frame-ms", "10", "--report", folder / "r.json"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto report = nlohmann::json::parse(readText(folder / "r.json"));
  ASSERT_EQ(report["steps"].size(), 4u);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(report["steps"][i].contains("stale_w")) << "frame " << i;
  EXPECT_GT(report["steps"][2]["deferred"], 0);
  const auto& settled = report["steps"][3];
  EXPECT_EQ(settled["op"], "settle");
  EXPECT_EQ(settled["deferred"], 0);
  EXPECT_GT(settled["leaves_changed"], 0);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["median"], 0.005);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["p95"], 0.03);
  EXPECT_EQ(report["check"]["particles_identical"], true);
  EXPECT_EQ(
      runCli({"replay", bundledScene("cornell/cornell.rad"), "--edits", folder / "e.json", "--frame-ms", "0"}).exitCode,
      2);
}

TEST(UpdateCommand, ASolutionFromAFileIsUpdatedIntoAnother) {
  const TempFolder folder;
  folder.write("e.json", kEdits);
  ASSERT_EQ(runCli({"solve", bundledScene("cornell/cornell.rad"), "-o", folder / "a.dlx"}).exitCode, 0);
  const auto result = runCli({"update", folder / "a.dlx", "--edits", folder / "e.json", "-o", folder / "b.dlx"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  // The updated one is a solution to go on with.
  const auto again = runCli({"update", folder / "b.dlx", "--edits", folder / "e.json", "-o", folder / "c.dlx"});
  EXPECT_EQ(again.exitCode, 0) << again.err;
  EXPECT_TRUE(std::filesystem::exists(folder / "c.dlx"));
}

TEST(UpdateCommand, ARecordingReplaysToTheSameResult) {
  const TempFolder folder;
  folder.write("e.json", kEdits);
  folder.write("lamp.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 50\n0 45 90\n0\n800 400 0\n");
  const auto recorded =
      runCli({"replay", bundledScene("cornell/cornell.rad"), "--ies", (folder / "lamp.ies").string() + "@0.3,0.4,0.3",
              "--edits", folder / "e.json", "--error", "0.1", "--seed", "7", "--record", folder / "session.json",
              "--report", folder / "a.json", "--check"});
  ASSERT_EQ(recorded.exitCode, 0) << recorded.err;
  // Nothing but the recording, and the files it names, says what is played.
  std::filesystem::remove(folder / "e.json");
  const auto replayed = runCli({"replay", folder / "session.json", "--report", folder / "b.json", "--check"});
  ASSERT_EQ(replayed.exitCode, 0) << replayed.err;
  auto a = nlohmann::json::parse(readText(folder / "a.json")), b = nlohmann::json::parse(readText(folder / "b.json"));
  EXPECT_EQ(b["seed"], 7);
  EXPECT_EQ(a["scene_stats"]["lights"], 2);
  for (const char* same : {"scene_stats", "counts"}) EXPECT_EQ(a[same], b[same]);
  for (const char* same : {"emitted_w", "absorbed_w"}) EXPECT_EQ(a["energy"][same], b["energy"][same]);
  ASSERT_EQ(a["steps"].size(), b["steps"].size());
  for (std::size_t i = 0; i < a["steps"].size(); ++i) {
    a["steps"][i].erase("time_s"), b["steps"][i].erase("time_s");
    EXPECT_EQ(a["steps"][i], b["steps"][i]);
  }
  EXPECT_EQ(a["check"]["irradiance_rel_diff"], b["check"]["irradiance_rel_diff"]);
}

TEST(UpdateCommand, ARecordingSaysItselfWhatIsPlayed) {
  const TempFolder folder;
  folder.write("session.json", R"({"recording": 1, "scene": ["room.rad"], "edits": []})");
  test::expectUsageError({"replay", folder / "session.json", "--error", "0.1"});
  test::expectUsageError({"replay", folder / "session.json", "--edits", folder / "e.json"});
  test::expectUsageError({"replay", bundledScene("cornell/cornell.rad")});
  const auto missing = runCli({"replay", folder / "session.json"});
  EXPECT_EQ(missing.exitCode, 3) << missing.err;
  EXPECT_NE(missing.err.find("room.rad"), std::string::npos) << missing.err;
}

TEST(UpdateCommand, AnEditThatCannotBeIsRefusedBeforeAnythingIsDone) {
  const TempFolder folder;
  folder.write("e.json", R"({"edits": [{"op": "remove", "object": "short_blok"}]})");
  const auto result =
      runCli({"update", bundledScene("cornell/cornell.rad"), "--edits", folder / "e.json", "-o", folder / "b.dlx"});
  EXPECT_EQ(result.exitCode, 3) << result.err;
  EXPECT_NE(result.err.find("short_block"), std::string::npos) << result.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "b.dlx"));
}

}  // namespace
}  // namespace deltalux
