#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::CliResult;
using test::runCli;
using Json = nlohmann::json;
using Names = std::vector<std::string>;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Info, SaysWhatIsThere) {
  const CliResult result = runCli({"info", bundledScene("cornell-caustic/cornell-caustic.rad")});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* part :
       {"17 polygon", "1 sphere", "short_block: 5 primitives", "tall_block: 5 primitives", "glass: dielectric",
        "tall_block_surface: mirror 0.9 0.9 0.9", "white: opaque, diffuse 0.725 0.71 0.68", "emits 17 12 4 W/(sr m2)",
        "lamp: area, polygon", "up is 0 0 1"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
}

TEST(Info, ReportsTheSameNumbers) {
  const test::TempFolder folder;
  const std::string scene = bundledScene("ring/ring.rad"), report = folder / "r.json";
  const CliResult result = runCli({"info", scene, "--quiet", "--report", report});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  const Json json = Json::parse(test::readText(report));
  EXPECT_EQ(json["command"], "info");
  EXPECT_EQ(json["scene"], scene);
  EXPECT_EQ(json["scene_stats"]["primitives"], 6);
  EXPECT_EQ(json["scene_stats"]["lights"], 2);
  EXPECT_TRUE(json["scene_stats"]["ignored"].empty());
  EXPECT_GT(json["scene_stats"]["polygons_if_tessellated"], 24 * 2);
  EXPECT_GT(json["memory_bytes"]["peak_rss"], 0);
  EXPECT_GE(json["time_s"]["total"], json["time_s"]["import"]);
  EXPECT_EQ(folder.names(), Names{"r.json"});
}

TEST(Info, ASceneWithoutLightSaysSo) {
  const test::TempFolder folder;
  const std::string grey = "void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere ball 0 0 4 0 0 0 1\n";
  const auto warned = [](const std::vector<std::string>& arguments) {
    const CliResult result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return contains(result.err, "warning: the scene has no light");
  };
  const std::string dark = folder.write("dark.rad", grey);
  EXPECT_TRUE(warned({"info", dark}));
  const std::string off = "void light off 0 0 3 0 0 0\noff sphere lamp 0 0 4 0 0 9 1\n";
  EXPECT_TRUE(warned({"info", folder.write("off.rad", grey + off)}));
  const std::string lamp = "void light on 0 0 3 1 1 1\non sphere lamp 0 0 4 0 0 9 1\n";
  EXPECT_FALSE(warned({"info", folder.write("lit.rad", grey + lamp)}));
  const std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n100 100\n";
  EXPECT_FALSE(warned({"info", dark, "--ies", folder.write("lamp.ies", ies).string() + "@0,0,9"}));
  EXPECT_TRUE(warned({"solve", dark, "-o", folder / "dark.dlx"}));
  const std::string points = folder.write("p.csv", "x,y,z,nx,ny,nz\n0,0,1,0,0,1\n");
  EXPECT_TRUE(warned({"probe", folder / "dark.dlx", "--points", points, "-o", folder / "o.csv"}));
  EXPECT_TRUE(warned({"reference", dark, "--points", points, "-o", folder / "o.csv", "--samples", "4"}));
}

TEST(Info, NumbersTooLargeAreMistakes) {
  const test::TempFolder folder;
  const auto result =
      runCli({"info", folder.write("a.rad", "void light l 0 0 3 1e400 10 10\nl sphere s 0 0 4 0 0 1 .1\n")});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_TRUE(contains(result.err, "a.rad:1")) << result.err;
}

TEST(Info, ReadsSeveralFilesAsOneScene) {
  const test::TempFolder folder;
  const auto materials = folder.write("mat.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n");
  const auto surfaces = folder.write("surf.rad", "grey sphere ball 0 0 4 0 0 0 1\n");
  EXPECT_EQ(runCli({"info", materials, surfaces}).exitCode, 0);
  EXPECT_EQ(runCli({"info", surfaces, materials}).exitCode, 3);  // the modifier is not there yet
}

TEST(Info, WrongInputIsExitCodeThreeWithFileAndLine) {
  const test::TempFolder folder;
  const std::string broken =
      folder.write("broken.rad", "void plastic grey 0 0 5 .5 .5 .5 0 0\n\ngrey sphere ball 0 0 3 0 0 0\n");
  const std::string report = folder.write("r.json", "old");
  const CliResult result = runCli({"info", broken, "--report", report});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, broken + ":3")) << result.err;
  EXPECT_EQ(test::readText(report), "old");

  EXPECT_EQ(runCli({"info", folder / "none.rad"}).exitCode, 3);
  EXPECT_EQ(runCli({"info", folder.path()}).exitCode, 3);
  EXPECT_EQ(folder.names(), (Names{"broken.rad", "r.json"}));
}

TEST(Info, ReportWithoutAPlaceIsExitCodeFour) {
  const test::TempFolder folder;
  const CliResult result = runCli({"info", bundledScene("ring/ring.rad"), "--report", folder / "none/r.json"});
  EXPECT_EQ(result.exitCode, 4);
  EXPECT_EQ(result.out, "");
  EXPECT_TRUE(contains(result.err, "there is no folder")) << result.err;
  EXPECT_TRUE(folder.names().empty());
}

TEST(Info, AddsMeasuredLightsStraightDown) {
  const test::TempFolder folder;
  const std::string lamp =
      folder.write("lamp.ies",
                   "IESNA:LM-63-2002\n[TEST] a downlight\nTILT=NONE\n1 1000 1 3 1 1 2 0 0 0\n1 1 100\n"
                   "0 45 90\n0\n320 250 0\n");
  const CliResult result =
      runCli({"info", bundledScene("ring/ring.rad"), "--ies", lamp + "@1,2.5,3", "--ies", lamp + "@-1,0,3"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_TRUE(contains(result.out, "lamp: area"));  // the ring scene has a lamp of its own
  EXPECT_TRUE(contains(result.out, "lamp-2: measured at 1 2.5 3 aimed at -0 -0 -1, up to 320 cd") ||
              contains(result.out, "lamp-2: measured at 1 2.5 3 aimed at 0 0 -1, up to 320 cd"))
      << result.out;
  EXPECT_TRUE(contains(result.out, "lamp-3: measured at -1 0 3")) << result.out;
  EXPECT_EQ(
      runCli({"info", bundledScene("ring/ring.rad"), "--ies", (folder / "none.ies").string() + "@0,0,1"}).exitCode, 3);
}

TEST(Info, FindsEverySurfaceOfTheCabin) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const CliResult result = runCli({"info", shared / "scenes/cabin/cabin.rad"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  for (const char* part : {"surfaces read  2839", "1507 polygon", "644 cylinder", "512 sphere", "149 cone", "23 ring",
                           "1 tube", "3 source"})
    EXPECT_TRUE(contains(result.out, part)) << part;
}

TEST(Info, ReadsTheAuthoredCabin) {
  DELTALUX_SHARED_OR_SKIP(shared);
  std::vector<std::string> arguments{"info"};
  for (const char* file : {"testmats", "cabin", "bathroom", "furniture", "winpanes.rad", "mirrors.rad", "lights"})
    arguments.push_back(shared / "scenes/cabin-original" / file);
  const CliResult result = runCli(arguments);
  EXPECT_EQ(result.exitCode, 0) << result.err;
}

TEST(Info, DescribesALuminaireAndDrawsIt) {
  const test::TempFolder folder;
  // Lambertian: pi I lumens, half of I at 60 degrees to either side; 12 cm along C0.
  std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 181 1 1 2 .1 .12 0\n1 1 10\n", candela;
  for (int v = 0; v <= 180; ++v) {
    ies += std::to_string(v) + (v % 10 == 9 ? "\n" : " ");
    candela += std::to_string(v < 90 ? 1000 * std::cos(v * 3.14159265358979 / 180) : 0.0) + (v % 10 == 9 ? "\n" : " ");
  }
  folder.write("disc & co.ies", ies + "\n0\n" + candela + "\n");
  const std::string svg = folder / "polar.svg";
  const CliResult result = runCli({"info", folder / "disc & co.ies", "-o", svg});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  for (const char* part :
       {"3142 lm, 100 % of it downwards", "at most 1000 cd", "gamma 0", "within 120 degrees", "0.12 m along C0"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
  const std::string drawn = test::readText(svg);
  EXPECT_TRUE(contains(drawn, "disc &amp; co.ies"));
  EXPECT_TRUE(contains(drawn, "</svg>"));
  test::expectUsageError({"info", bundledScene("ring/ring.rad"), "-o", svg});
  EXPECT_EQ(runCli({"info", folder / "disc & co.ies", "-o", folder / "none/polar.svg"}).exitCode, 4);
}

TEST(Info, DescribesALuminaireOfTm33) {
  const test::TempFolder folder;
  const std::string lamp = folder.write("lamp.xml",
                                        R"(<?xml version="1.0"?>
<IESTM33-22><Version>1.1</Version><Header><Description>Downlight</Description></Header>
<Emitter><Quantity>1</Quantity><LuminousData><LuminousIntensity><Symm>Symm_Full</Symm>
<IntData h="0" v="0">500</IntData><IntData h="0" v="45">250</IntData><IntData h="0" v="90">0</IntData>
</LuminousIntensity></LuminousData></Emitter></IESTM33-22>)");
  const CliResult result = runCli({"info", lamp, "-o", folder / "polar.svg"});
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* part : {"lamp.xml: 1", " lm, 100 % of it downwards", "at most 500 cd"})
    EXPECT_TRUE(contains(result.out, part)) << part << "\n" << result.out;
  EXPECT_TRUE(contains(test::readText(folder / "polar.svg"), "<svg"));
  const CliResult wrong = runCli({"info", folder.write("wrong.xml", "<IESTM33-22>\n<Emitter>")});
  EXPECT_EQ(wrong.exitCode, 3);
  EXPECT_TRUE(contains(wrong.err, "wrong.xml:2: is not XML")) << wrong.err;
}

TEST(Info, PutsADaylightOverAScene) {
  const std::string scene = bundledScene("street/night.rad");
  const CliResult lit =
      runCli({"info", scene, "--sky", "perez:800,100", "--when", "2026-06-21T09:00+02:00", "--where", "47.37,8.54"});
  EXPECT_EQ(lit.exitCode, 0) << lit.err;
  EXPECT_TRUE(contains(lit.err, "daylight: the sun 3")) << lit.err;
  for (const char* part : {"sun: sun", "sky: "}) EXPECT_TRUE(contains(lit.out, part)) << part << "\n" << lit.out;
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"--sky", "cie:12"},
                                                {"--sky", "cie:16", "--when", "2026-06-21T09:00", "--where", "0,0"},
                                                {"--when", "2026-06-21T09:00"},
                                                {"--sky", "cie:1", "--when", "noon", "--where", "0,0"},
                                                {"--sky", "cie:1", "--when", "2026-06-21T09:00", "--where", "100,0"}}) {
    std::vector<std::string> all{"info", scene};
    all.insert(all.end(), wrong.begin(), wrong.end());
    EXPECT_EQ(runCli(all).exitCode, 2) << wrong[0] << wrong[1];
  }
}

}  // namespace
}  // namespace deltalux
