// Instances and meshes, by the sources beside them.
#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"

namespace deltalux::io::radiance::test {
namespace {

const char* const kPaints = "void plastic red 0 0 5 .8 0 0 0 0\nvoid plastic blue 0 0 5 0 0 .8 0 0\n";

TEST(Compound, InstancesStandWhereTheirTransformPutsThem) {
  const std::map<std::string, std::string> files{
      {"chair.rad", "red sphere seat 0 0 4 0 0 1 .5\nblue ring foot 0 0 8 0 0 0 0 0 1 0 1\n"}};
  const ImportedScene imported = read(std::string(kPaints) +
                                          "void instance left 7 chair.oct -s 2 -t 3 0 0\n0 0\n"
                                          "blue instance right 1 chair.oct 0 0\n",
                                      files);
  const Scene& scene = imported.scene;
  EXPECT_TRUE(imported.report.warnings.empty());
  ASSERT_EQ(scene.primitives.size(), 4u);
  EXPECT_EQ(std::get<Sphere>(scene.primitives[0].shape).center, Vec3(3, 0, 2));
  EXPECT_EQ(std::get<Sphere>(scene.primitives[0].shape).radius, 1);
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "red");
  EXPECT_EQ(scene.materialOf(PrimitiveId(2)).name, "blue");  // all of it
  EXPECT_EQ(scene[scene.primitives[1].object].name, "left.foot");
  EXPECT_EQ(primitivesOf(scene, findObjects(scene, "right").at(0)).size(), 2u);
}

TEST(Compound, MeshesAreTheirWavefrontFile) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\nf 1 2 3 4\nusemtl unheard\nf 1 4 3\n";
  const ImportedScene imported =
      read(std::string(kPaints) + "void mesh sheet 3 sheet.rtm -rx 90\n0 0\nblue mesh other 1 sheet.rtm 0 0\n",
           {{"sheet.obj", obj}});
  const Scene& scene = imported.scene;
  ASSERT_EQ(scene.primitives.size(), 3u);
  EXPECT_NEAR(area(scene.primitives[0].shape), 1, 1e-9);
  EXPECT_NEAR(bounds(scene.primitives[0].shape).upper.z, 1, 1e-9);
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "red");
  EXPECT_EQ(scene.materialOf(PrimitiveId(1)).name, "blue");
  EXPECT_EQ(imported.report.ignored.at("surface without material"), 1u);
}

TEST(Compound, WithoutSourcesTheyAreCounted) {
  const ImportedScene imported =
      read(std::string(kPaints) + "void instance a 1 x.oct 0 0\nred mesh b 1 y.rtm 0 0\nred sphere s 0 0 4 0 0 0 1\n");
  EXPECT_EQ(imported.report.ignored, (std::map<std::string, std::size_t>{{"instance", 1}, {"mesh", 1}}));
}

TEST(Compound, MistakesAreInputErrors) {
  EXPECT_NE(errorOf("void instance a 3 x.oct -q 1 0 0\n", {{"x.rad", "void plastic p 0 0 5 1 1 1 0 0\n"}})
                .find("no transform option"),
            std::string::npos);
  EXPECT_NE(
      errorOf("void instance a 1 x.oct 0 0\n", {{"x.rad", "void instance b 1 x.oct 0 0\n"}}).find("includes itself"),
      std::string::npos);
  EXPECT_NE(errorOf("void mesh a 1 x.rtm 0 0\n", {{"x.obj", "v 0 0\nf 1 2 3\n"}}), "");
}

}  // namespace
}  // namespace deltalux::io::radiance::test
