#include "io/obj/mtl.hpp"

#include <gtest/gtest.h>

#include <deltalux/error.hpp>

namespace deltalux {
using namespace io;

namespace {

struct Read {
  std::vector<tinyobj::material_t> materials;
  std::map<std::string, std::size_t> ignored;
};

Read read(const std::string& text) {
  Read r;
  r.materials = readMtl(text, "m.mtl", r.ignored);
  return r;
}

tinyobj::material_t one(const std::string& statements) { return read("newmtl a\n" + statements).materials.at(0); }

std::vector<double> colour(const tinyobj::real_t (&c)[3]) { return {c[0], c[1], c[2]}; }
using Colour = std::vector<double>;

InputError refusal(const std::string& statements) {
  try {
    one(statements);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "m.mtl");
    EXPECT_FALSE(error.hint().empty());
    return error;
  }
  ADD_FAILURE() << "was read: " << statements;
  return {"", 0, ""};
}

/// How many things of the kind that starts with `kind` were counted.
std::size_t counted(const std::string& statements, const std::string& kind) {
  std::size_t sum = 0;
  for (const auto& [name, count] : read("newmtl a\n" + statements).ignored)
    if (name.starts_with(kind)) sum += count;
  return sum;
}

TEST(Mtl, OneNumberIsGrey) {
  EXPECT_EQ(colour(one("Ke 10\n").emission), Colour({10, 10, 10}));
  EXPECT_EQ(colour(one("Kd .5 # grey\n").diffuse), Colour({.5, .5, .5}));
  EXPECT_EQ(colour(one("Ks +.25\n").specular), Colour({.25, .25, .25}));
  EXPECT_EQ(colour(one("Tf .75\n").transmittance), Colour({.75, .75, .75}));
  EXPECT_EQ(colour(one("ke 1 2 3\n").emission), Colour({1, 2, 3}));
  EXPECT_TRUE(read("newmtl a\nKe 10\nKd .5 # grey\n").ignored.empty());
}

TEST(Mtl, SeveralMaterialsWithTheirDefaults) {
  const Read r = read("# made by hand\n\nnewmtl my paint \n\tKd 0.1 0.2 0.3\nKs 0.1\\\n 0.1 0.1\nnewmtl b\n");
  ASSERT_EQ(r.materials.size(), 2u);
  EXPECT_EQ(r.materials[0].name, "my paint");
  EXPECT_EQ(colour(r.materials[0].diffuse), Colour({.1, .2, .3}));
  EXPECT_EQ(colour(r.materials[0].specular), Colour({.1, .1, .1}));
  EXPECT_EQ(r.materials[1].dissolve, 1);
  EXPECT_EQ(r.materials[1].ior, 1);
  EXPECT_EQ(colour(r.materials[1].diffuse), Colour({0, 0, 0}));
  EXPECT_EQ(read("Kd 1 1 1\n").ignored.at("MTL statements before newmtl"), 1u);
}

TEST(Mtl, OtherFormsOfColourAreRefusedWithTheirLine) {
  for (const char* form : {"spectral file.rfl 1", "xyz 1 1 1", "bright", "nan nan nan", "1 inf 1", "1e400", "0.5 0.5",
                           "", "0,5 0,5 0,5", "1 2 abc"}) {
    for (const char* keyword : {"Kd", "Ks", "Ke", "Tf"}) {
      const InputError error = refusal("Ns 1\n" + std::string(keyword) + " " + form + "\n");
      EXPECT_EQ(error.line(), 3) << form;
      EXPECT_TRUE(error.message().starts_with(keyword)) << error.message();
    }
  }
  EXPECT_NE(refusal("Ke spectral a.rfl\n").message().find("spectral"), std::string::npos);
  EXPECT_NE(refusal("Ke xyz 1\n").message().find("XYZ"), std::string::npos);
  EXPECT_EQ(refusal("Ke -1 0 0\n").line(), 2);
  EXPECT_EQ(refusal("Ke 1e20\n").line(), 2);
  EXPECT_EQ(refusal(std::string("Kd 1\0", 5)).line(), 0);
}

TEST(Mtl, ColoursBeyondTheirRangeAreCutAndCounted) {
  EXPECT_EQ(colour(one("Kd 7 -3 0.5\n").diffuse), Colour({1, 0, .5}));
  EXPECT_EQ(counted("Kd 7 -3 0.5\nKs 2\n", "colours above 1"), 2u);
  EXPECT_EQ(counted("Kd 7 -3 0.5\nKs 2\n", "colours below 0"), 1u);
  EXPECT_EQ(counted("Ke 7 8 9\n", "colours"), 0u);
  EXPECT_EQ(counted("Kd .5 .5 .5 1\n", "numbers too many"), 1u);
}

TEST(Mtl, Dissolve) {
  EXPECT_EQ(one("d 0.25\n").dissolve, 0.25);
  EXPECT_EQ(one("d -halo 0.25\n").dissolve, 0.25);
  EXPECT_EQ(counted("d -halo 0.25\n", "-halo"), 1u);
  EXPECT_EQ(one("Tr 0.25\n").dissolve, 0.75);
  EXPECT_EQ(one("Tr 0.25 0.25 0.25\n").dissolve, 0.75);
  EXPECT_EQ(counted("d 0.75\nTr 0.25\n", "Tr that"), 0u);
  for (const char* both : {"d 0.25\nTr 0.25\n", "Tr 0.25\nd 0.25\n"}) {
    EXPECT_EQ(one(both).dissolve, 0.25) << "d counts";
    EXPECT_EQ(counted(both, "Tr that contradict d"), 1u);
  }
  EXPECT_EQ(one("d 1.5\n").dissolve, 1);
  EXPECT_EQ(one("Tr 2\n").dissolve, 0);
  EXPECT_EQ(counted("d 1.5\nTr -1\n", "MTL parameters out of range"), 2u);
  for (const char* wrong : {"d\n", "d -halo\n", "d half\n", "Tr\n", "Tr nan\n", "Tr 0 0 1\n", "d 1e400\n"})
    EXPECT_EQ(refusal(wrong).line(), 2) << wrong;
}

TEST(Mtl, OtherParameters) {
  const tinyobj::material_t m = one("Ns 98\nNi 1.5\nillum 7\nPr 0.5\nPm 1\nsharpness 60\nKa what ever\n");
  EXPECT_EQ(m.shininess, 98);
  EXPECT_EQ(m.ior, 1.5);
  EXPECT_EQ(m.illum, 7);
  EXPECT_EQ(m.roughness, 0.5);
  EXPECT_EQ(m.metallic, 1);
  EXPECT_EQ(counted("Pcr 0.5\n", "MTL statements not known"), 1u);
  EXPECT_EQ(refusal("Ns shiny\n").line(), 2);
  EXPECT_EQ(refusal("illum\n").line(), 2);
}

TEST(Mtl, MapsBehindTheirOptions) {
  EXPECT_EQ(one("map_Kd wood grain.tga\n").diffuse_texname, "wood grain.tga");
  EXPECT_EQ(colour(one("map_Kd a.png\n").diffuse), Colour({.6, .6, .6}));
  EXPECT_EQ(colour(one("Kd 1 1 1\nmap_Kd a.png\n").diffuse), Colour({1, 1, 1}));
  const std::string options = "map_Kd -s 2 2 2 -o 0.5 -mm 0 1 -clamp on -blendu off 3 small.png\n";
  EXPECT_EQ(one(options).diffuse_texname, "3 small.png");
  EXPECT_EQ(one("map_Kd -o 1 2.png\n").diffuse_texname, "2.png");
  EXPECT_EQ(counted(options, "options of map_Kd"), 1u);
  EXPECT_EQ(counted("map_Bump -bm 1 a.png\nbump a.png\nmap_Ke a.png\n", "material maps other than map_Kd"), 3u);
  EXPECT_EQ(refusal("map_Kd\n").line(), 2);
  EXPECT_EQ(refusal("map_Kd -clamp on\n").line(), 2);
}

}  // namespace
}  // namespace deltalux
