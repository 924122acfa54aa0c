// What is wrong with the command line itself: exit code 2, one message, nothing touched.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::CliResult;
using test::runCli;
using Arguments = std::vector<std::string>;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(CommandLine, HelpAndVersionAreAnsweredOnStandardOutput) {
  for (const Arguments& arguments : {Arguments{"--help"}, {"-h"}, {"info", "--help"}}) {
    const CliResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 0);
    EXPECT_TRUE(contains(result.out, "Usage:"));
    EXPECT_EQ(result.err, "");
  }
  EXPECT_TRUE(contains(runCli({"--help"}).out, "130 interrupted"));
  const CliResult version = runCli({"--version"});
  EXPECT_EQ(version.exitCode, 0);
  EXPECT_TRUE(contains(version.out, "deltalux 0."));
}

TEST(CommandLine, MistakesAreExitCodeTwo) {
  const std::string scene = bundledScene("cornell/cornell.rad");
  const std::vector<Arguments> wrong{
      {},
      {"nonsense"},
      {"info"},
      {"info", "--nonsense", scene},
      {"info", scene, "--metres-per-unit", "0"},
      {"info", scene, "--metres-per-unit", "long"},
      {"info", scene, "--efficacy", "683"},                                           // .rad scenes hold watts
      {"info", bundledScene("furnace/furnace.gltf"), "--metres-per-unit", "0.3048"},  // glTF scenes are in metres
      {"info", scene, "--ies", "lamp.ies"},
      {"info", scene, "--ies", "lamp.ies@1,2"},
      {"info", scene, "--ies", "lamp.ies@1,2,3,4"},
      {"info", scene, "--ies", "lamp.ies@1,2,x"},
      {"info", scene, "--ies", "@1,2,3"},
  };
  for (const Arguments& arguments : wrong) test::expectUsageError(arguments);
}

TEST(CommandLine, OnlyCommandsThatWorkAreListed) {
  const std::string help = runCli({"--help"}).out;
  EXPECT_TRUE(contains(help, "\n  info "));
  for (const std::string command :
       {"info", "solve", "update", "replay", "probe", "render", "reference", "export", "view"}) {
    const bool listed = contains(help, "\n  " + command + " ");
    const bool known = !contains(runCli({command}).err, "there is no command");
    EXPECT_EQ(listed, known) << command;
  }
}

TEST(CommandLine, FullDisksAreExitCodeFour) {
  const test::TempFolder folder;
  const std::string command =
      fmt::format("{} info {} >/dev/full 2>/dev/null", DELTALUX_CLI, bundledScene("plates/parallel.rad"));
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 4);
}

}  // namespace
}  // namespace deltalux
