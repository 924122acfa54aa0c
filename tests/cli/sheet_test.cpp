#include <gtest/gtest.h>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;
using test::TempFolder;

TEST(SheetCommand, WritesTheSheetOfARoom) {
  const TempFolder folder;
  folder.write("a.json",
               "{\"title\": \"Box\", \"areas\": [{\"name\": \"floor\", \"surface\": \"floor\", \"spacing\": 0.1, "
               "\"border\": 0,\n"
               "\"walls\": [\"back\"], \"required\": {\"Em\": 1, \"U0\": 0.99}}]}");
  const auto result = runCli({"sheet", bundledScene("cornell/cornell.rad"), "--error", "0.2", "--areas",
                              folder / "a.json", "-o", folder / "s.html"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("floor: FAIL"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("0 of 1 areas pass"), std::string::npos) << result.out;
  EXPECT_NE(test::readText(folder / "s.html").find("Em, walls"), std::string::npos);
}

TEST(SheetCommand, MistakesAreToldWithTheirLineAndWriteNothing) {
  const std::string scene = bundledScene("cornell/cornell.rad");
  const TempFolder folder;
  folder.write("surface.json",
               "{\"areas\": [\n{\"name\": \"a\", \"surface\": \"floor\"},\n{\"name\": \"b\", \"surface\": \"flor\"}]}");
  folder.write("json.json", "{\"areas\": [\n{\"name\": \"a\",,}]}");
  folder.write("view.json", "{\"view\": \"none.vf\", \"areas\": [{\"name\": \"a\", \"surface\": \"floor\"}]}");
  const auto run = [&](const std::string& areas, const std::string& out) {
    return runCli({"sheet", scene, "--areas", folder / areas, "-o", folder / out});
  };
  const auto surface = run("surface.json", "s.html");
  EXPECT_EQ(surface.exitCode, 3);
  EXPECT_NE(surface.err.find("surface.json:3: "), std::string::npos) << surface.err;
  EXPECT_NE(surface.err.find("floor"), std::string::npos) << surface.err;
  const auto json = run("json.json", "s.html");
  EXPECT_EQ(json.exitCode, 3);
  EXPECT_NE(json.err.find("json.json:2: "), std::string::npos) << json.err;
  EXPECT_EQ(run("view.json", "s.html").exitCode, 3);
  EXPECT_EQ(run("none.json", "s.html").exitCode, 3);
  EXPECT_EQ(run("surface.json", "none/s.html").exitCode, 4);
  test::expectUsageError({"sheet", scene, "--areas", folder / "view.json", "-o", folder / "s.txt"});
  test::expectUsageError({"sheet", scene, "-o", folder / "s.html"});
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"json.json", "surface.json", "view.json"}));
}

}  // namespace
}  // namespace deltalux
