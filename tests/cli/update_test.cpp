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
  EXPECT_GT(report["steps"][0]["links_visited"], 0);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["median"], 0.005);
  EXPECT_LT(report["check"]["irradiance_rel_diff"]["p95"], 0.03);
  EXPECT_EQ(report["check"]["particles_identical"], true);
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
