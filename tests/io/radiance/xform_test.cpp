#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"

namespace deltalux::io::radiance::test {
namespace {

Vec3 center(const RadObject& sphere) { return {sphere.reals[0], sphere.reals[1], sphere.reals[2]}; }

/// Where `xform OPTIONS` puts a sphere at (1,2,3) of radius 1.
RadObject sphereAfter(const std::string& options) {
  return expand("!xform " + options + " ball", {{"ball", "m sphere ball 0 0 4 1 2 3 1"}}).at(0);
}

void expectAt(const std::string& options, const Vec3& position, double radius = 1) {
  const RadObject sphere = sphereAfter(options);
  EXPECT_NEAR(glm::distance(center(sphere), position), 0, 1e-12) << options;
  EXPECT_NEAR(sphere.reals[3], radius, 1e-12) << options;
}

TEST(Xform, AppliesOptionsInOrder) {
  expectAt("-t 1 0 0 -s 2", {4, 4, 6}, 2);
  expectAt("-s 2 -t 1 0 0", {3, 4, 6}, 2);
  expectAt("-rx 90", {1, -3, 2});
  expectAt("-ry 90", {3, 2, -1});
  expectAt("-rz 90", {-2, 1, 3});
  expectAt("-mx -my -mz", {-1, -2, -3});
  expectAt("-s -2", {-2, -4, -6}, 2);
}

TEST(Xform, IterationRepeatsWhatFollowsIt) {
  expectAt("-t 1 0 0 -i 3 -t 0 1 0", {2, 5, 3});
  expectAt("-i 0 -t 5 5 5 -i 2 -t 1 0 0", {3, 2, 3});
  expectAt("-i 100 -rz 3.6", {1, 2, 3});
}

TEST(Xform, NamesArraysAsRadianceDoes) {
  const std::map<std::string, std::string> ball{{"ball", "m sphere ball 0 0 4 0 0 0 1"}};
  const auto grid = expand("!xform -n g -t 1 0 0 -a 2 -t 10 0 0 -a 3 -t 0 5 0 ball", ball);
  ASSERT_EQ(grid.size(), 6u);
  EXPECT_EQ(grid[0].name, "g.0.0.ball");
  EXPECT_EQ(grid[5].name, "g.1.2.ball");
  EXPECT_EQ(center(grid[5]), Vec3(11, 10, 0));
  EXPECT_EQ(center(grid[2]), Vec3(1, 10, 0));
  const auto unnamed = expand("!xform -a 2 -t 1 0 0 -a 2 -t 0 1 0 ball", ball);
  EXPECT_EQ(unnamed[1].name, "a0.1.ball");
  EXPECT_EQ(expand("!xform -n a -n b ball", ball)[0].name, "a.b.ball");
  EXPECT_EQ(expand("!xform -t 1 1 1 ball", ball)[0].name, "ball");
}

TEST(Xform, ModifiersKeepTheirNamesAndGetTheirOwnTransforms) {
  const auto objects =
      expand("!xform -n x -s 2 -rz 90 lamp", {{"lamp",
                                               "void spotlight s 0 0 7 1 1 1 30 1 0 0  void glow g 0 0 4 1 1 1 3\n"
                                               "void dielectric d 0 0 5 .25 .25 .25 1.5 0  s source e 0 0 4 1 0 0 5\n"
                                               "void brightfunc sky 2 skybr skybright.cal 0 7 1 1 1 1 1 0 0"}});
  EXPECT_EQ(objects[0].name, "s");
  EXPECT_NEAR(objects[0].reals[5], 2, 1e-12);  // direction (1,0,0) -> (0,2,0)
  EXPECT_NEAR(objects[1].reals[3], 6, 1e-12);
  EXPECT_NEAR(objects[2].reals[0], 0.5, 1e-12);  // per unit length, of units half as long
  EXPECT_EQ(objects[3].name, "x.e");
  EXPECT_NEAR(objects[3].reals[1], 2, 1e-12);
  EXPECT_NEAR(objects[4].reals[5], 1, 1e-12);
}

TEST(Xform, ReplacesModifiersOfSurfacesOnly) {
  const auto objects =
      expand("!xform -m new part", {{"part", "void plastic p 0 0 5 0 0 0 0 0 p sphere s 0 0 4 0 0 0 1"}});
  EXPECT_EQ(objects[0].modifier, "void");
  EXPECT_EQ(objects[1].modifier, "new");
}

TEST(Xform, MirroringKeepsOutsidesOutside) {
  const std::string box = "!genbox m b 1 2 3";
  EXPECT_NEAR(enclosedVolume(expand(box)), 6, 1e-12);
  for (const char* options : {"-mx", "-my -mz", "-mx -my -mz -s 1", "-s -1", "-rx 30 -mz -t 1 2 3"}) {
    EXPECT_NEAR(enclosedVolume(expand(box + " | xform " + options)), 6, 1e-12) << options;
    EXPECT_NEAR(enclosedVolume(expand(box + " | xform -I " + options)), -6, 1e-12) << options;
  }
  EXPECT_NEAR(enclosedVolume(expand(box + " | xform -mx | xform -s 2 | xform -I -I -my")), 48, 1e-12);
}

TEST(Xform, InvertsCurvedSurfaces) {
  const auto objects = expand("!xform -I all", {{"all",
                                                 "m sphere a 0 0 4 0 0 0 1 m bubble b 0 0 4 0 0 0 1\n"
                                                 "m cylinder c 0 0 7 0 0 0 0 0 1 1 m tube d 0 0 7 0 0 0 0 0 1 1\n"
                                                 "m cone e 0 0 8 0 0 0 0 0 1 1 2 m cup f 0 0 8 0 0 0 0 0 1 1 2\n"
                                                 "m ring g 0 0 8 0 0 0 0 0 1 1 2"}});
  const std::vector<std::string> expected{"bubble", "sphere", "tube", "cylinder", "cup", "cone", "ring"};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(objects[i].typeName, expected[i]);
  EXPECT_EQ(objects[6].reals[5], -1);
}

TEST(Xform, IncludesNestAndReadPipes) {
  const auto objects =
      expand("!xform -n outer -t 1 0 0 house\n!genbox m post 1 1 1 | xform -n p -t 0 0 1",
             {{"house", "!xform -n inner -t 0 2 0 ball ball\n"}, {"ball", "m sphere s 0 0 4 0 0 0 1"}});
  ASSERT_EQ(objects.size(), 8u);
  EXPECT_EQ(objects[1].name, "outer.inner.s");
  EXPECT_EQ(center(objects[1]), Vec3(1, 2, 0));
  EXPECT_EQ(objects[2].name, "p.post.1540");
}

TEST(Xform, SaysWhatIsWrong) {
  const auto expectError = [](const std::string& text, const std::string& part,
                              const std::map<std::string, std::string>& files = {}) {
    const std::string error = errorOf(text, files);
    EXPECT_NE(error.find(part), std::string::npos) << text << "\n" << error;
  };
  expectError("!xform nowhere", "test.rad:1: cannot find the file 'nowhere'");
  expectError("\n!xform loop", "loop:1: 'loop' includes itself", {{"loop", "!xform -t 1 1 1 loop"}});
  expectError("!xform a", "'a' includes itself", {{"a", "!xform b"}, {"b", "!xform c"}, {"c", "!xform a"}});
  expectError("!xform -t 1 1", "-t needs a number");
  expectError("!xform -t 1 1 x ball", "'x' is no usable number");
  expectError("!xform -s 0 ball", "-s 0");
  expectError("!xform -q ball", "no option '-q'");
  expectError("!xform -a 0 ball", "makes no copy");
  expectError("!xform -a 1000000 -t 1 0 0 -a 1000000 -t 0 1 0 ball", "too many copies");
  expectError("!xform -t 1 0 0", "xform has no input");
  expectError("!xform -i 1000000 -s 2 ball", "overflows", {{"ball", ""}});
  expectError("!xform x > y", "needs a shell");
  expectError("!xform `ls`", "needs a shell");
  expectError("!xform \"$HOME\"", "needs a shell");
  expectError("!genbox m b 1 1 1 | sort", "a pipe into 'sort'");
  expectError("!", "empty command");
  expectError("!xform 'a", "without its partner");
}

TEST(Xform, LimitsWhatAFileExpandsTo) {
  ExpansionLimits limits;
  limits.objects = 50;
  const std::map<std::string, std::string> ball{{"ball", "m sphere s 0 0 4 0 0 0 1"}};
  EXPECT_EQ(expand("!xform -a 50 -t 1 0 0 ball", ball, limits).size(), 50u);
  EXPECT_THROW(expand("!xform -a 51 -t 1 0 0 ball", ball, limits), InputError);
  EXPECT_THROW(expand("!xform -a 30 -t 1 0 0 ball\n!xform -a 30 -t 1 0 0 ball", ball, limits), InputError);
}

TEST(CommandLine, QuotesAndContinuationsAsAShellReadsThem) {
  const auto objects = expand("!genworm m 'my worm' '3' \"2*t\" \\\n\t 4*t '1' \\\n 2 -e 'a=1;' # remark\n");
  ASSERT_EQ(objects.size(), 5u);
  EXPECT_EQ(objects[0].name, "my worm.s0");
  EXPECT_EQ(center(objects.back()), Vec3(3, 2, 4));
}

}  // namespace
}  // namespace deltalux::io::radiance::test
