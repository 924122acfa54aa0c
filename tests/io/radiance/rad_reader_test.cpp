#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"

namespace deltalux::io::radiance::test {
namespace {

const std::string kGrey = "void plastic grey 0 0 5 .5 .5 .5 0 0\n";

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(RadReader, ReadsEverySurface) {
  const auto [scene, report] = read(kGrey +
                                    "grey polygon p 0 0 9 0 0 0 1 0 0 0 1 0\n"
                                    "grey sphere s 0 0 4 0 0 0 1  grey bubble b 0 0 4 0 0 0 1\n"
                                    "grey cylinder c 0 0 7 0 0 0 0 0 1 2  grey tube t 0 0 7 0 0 0 0 0 1 2\n"
                                    "grey cone k 0 0 8 0 0 0 0 0 1 2 1  grey cup u 0 0 8 0 0 0 0 0 1 2 1\n"
                                    "grey ring r 0 0 8 0 0 0 0 0 2 3 1\n");
  ASSERT_EQ(scene.primitives.size(), 8u);
  EXPECT_EQ(report.surfaces.at("polygon"), 1u);
  EXPECT_EQ(report.surfaces.at("cup"), 1u);
  EXPECT_FALSE(std::get<Sphere>(scene.primitives[1].shape).inward);
  EXPECT_TRUE(std::get<Sphere>(scene.primitives[2].shape).inward);
  EXPECT_TRUE(std::get<Cylinder>(scene.primitives[4].shape).inward);
  EXPECT_TRUE(std::get<Cone>(scene.primitives[6].shape).inward);
  const Ring& ring = std::get<Ring>(scene.primitives[7].shape);
  EXPECT_EQ(ring.innerRadius, 1);
  EXPECT_EQ(ring.outerRadius, 3);
  EXPECT_EQ(ring.normal, Vec3(0, 0, 1));
  EXPECT_TRUE(report.warnings.empty());
  EXPECT_NO_THROW(validate(scene));
}

TEST(RadReader, NegativeRadiiTurnSurfacesInsideOut) {
  const Scene scene = read(kGrey +
                           "grey sphere s 0 0 4 0 0 0 -1  grey bubble b 0 0 4 0 0 0 -1\n"
                           "grey cylinder c 0 0 7 0 0 0 0 0 1 -2  grey cone k 0 0 8 0 0 0 0 0 1 -2 -1\n")
                          .scene;
  EXPECT_TRUE(std::get<Sphere>(scene.primitives[0].shape).inward);
  EXPECT_FALSE(std::get<Sphere>(scene.primitives[1].shape).inward);
  EXPECT_TRUE(std::get<Cylinder>(scene.primitives[2].shape).inward);
  EXPECT_TRUE(std::get<Cone>(scene.primitives[3].shape).inward);
  EXPECT_NO_THROW(validate(scene));
}

TEST(RadReader, QuotesCommentsAndLineEndings) {
  const Scene scene = read(
                          "# a comment\r\nvoid plastic \"two words\" 0 0 5 +.5 5e-1 .5 0 0\r\n# \n"
                          "'two words' sphere 'my ball' 0 0 4 0 0 0 1")
                          .scene;
  EXPECT_EQ(scene.materials[0].name, "two words");
  EXPECT_EQ(scene.objects[0].name, "my ball");
}

TEST(RadReader, AModifierMeansItsLastDefinitionBeforeTheUse) {
  const Scene scene = read(
                          "void plastic m 0 0 5 .1 .1 .1 0 0  m sphere a 0 0 4 0 0 0 1\n"
                          "void alias n m\n"
                          "void plastic m 0 0 5 .2 .2 .2 0 0  m sphere b 0 0 4 0 0 0 1  n sphere c 0 0 4 0 0 0 1\n"
                          "void plastic m 0 0 5 .1 .1 .1 0 0  m sphere d 0 0 4 0 0 0 1\n")
                          .scene;
  const auto rho = [&](std::size_t i) { return diffuseReflectance(scene.materialOf(PrimitiveId(i)), true).r; };
  EXPECT_FLOAT_EQ(rho(0), 0.1f);
  EXPECT_FLOAT_EQ(rho(1), 0.2f);
  EXPECT_FLOAT_EQ(rho(2), 0.1f);
  EXPECT_EQ(scene.primitives[3].material, scene.primitives[0].material);  // equal definitions share a material
  EXPECT_EQ(scene.materials.size(), 2u);
}

TEST(RadReader, PatternsThatCannotBeReadAreCountedInOneWarning) {
  const auto [scene, report] = read(kGrey +
                                    "void colorpict photo 7 red green blue x.hdr picture.cal u v 0 0\n"
                                    "photo plastic painted 0 0 5 1 1 1 0 0\n"
                                    "painted texfunc bumps 4 dx dy dz bumps.cal 0 0\n"
                                    "bumps sphere s 0 0 4 0 0 0 1\n"
                                    "void mixfunc half 4 grey painted .5 . 0 0\n"
                                    "half sphere t 0 0 4 0 0 0 1\n");
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "painted");
  EXPECT_EQ(scene.materialOf(PrimitiveId(1)).name, "grey");
  const auto rho = [&](std::size_t i) { return diffuseReflectance(scene.materialOf(PrimitiveId(i)), true).r; };
  const float grey = diffuseReflectance(scene.materials[0], true).r;
  EXPECT_FLOAT_EQ(rho(0), 1);
  EXPECT_FLOAT_EQ(rho(1), 0.5f * (grey + 1));  // half of each
  EXPECT_EQ(report.ignored,
            (std::map<std::string, std::size_t>{{"colorpict of a surface (cannot find 'x.hdr')", 1}, {"texfunc", 1}}));
  EXPECT_EQ(report.warnings,
            std::vector<std::string>{"ignored on import: 1 colorpict of a surface (cannot find 'x.hdr'), 1 texfunc"});
}

TEST(RadReader, SurfacesWithoutAreaOrMaterialAreCounted) {
  const auto [scene, report] = read(kGrey +
                                    "grey polygon p 0 0 9 0 0 0 1 0 0 2 0 0\n"
                                    "grey polygon p 0 0 9 1 1 1 1 1 1 1 1 1\n"
                                    "grey sphere s 0 0 4 0 0 0 0  grey ring r 0 0 8 0 0 0 0 0 1 1 1\n"
                                    "void sphere t 0 0 4 0 0 0 1\n"
                                    "void instance tree 1 tree.oct 0 0\n");
  EXPECT_TRUE(scene.primitives.empty());
  EXPECT_TRUE(scene.objects.empty());
  EXPECT_EQ(report.ignored.at("zero-area polygon"), 2u);
  EXPECT_EQ(report.ignored.at("zero-area sphere"), 1u);
  EXPECT_EQ(report.ignored.at("zero-area ring"), 1u);
  EXPECT_EQ(report.ignored.at("surface without material"), 1u);
  EXPECT_EQ(report.ignored.at("instance"), 1u);
  EXPECT_EQ(report.warnings.size(), 1u);
}

TEST(RadReader, BentPolygonsBecomeTriangles) {
  const auto [scene, report] = read(kGrey + "grey polygon p 0 0 12 0 0 0 1 0 0 1 1 .2 0 1 0\n");
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_EQ(std::get<Polygon>(scene.primitives[0].shape).vertices[2], Vec3(1, 1, 0.2));
  EXPECT_EQ(scene.primitives[0].object, scene.primitives[1].object);
  EXPECT_EQ(report.surfaces.at("polygon"), 1u);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_TRUE(contains(report.warnings[0], "test.rad:2"));
}

TEST(RadReader, SaysWhatIsWrongAndWhere) {
  const auto expectError = [](const std::string& text, const std::string& start, const std::string& part) {
    const std::string error = errorOf(text);
    EXPECT_TRUE(error.starts_with(start) && contains(error, part)) << text << "\n" << error;
  };
  expectError("void plastic m 0 0 4 1 1 1 0\n", "test.rad:1: ", "4 real arguments, not 5");
  expectError("\nvoid plastic m 0 0 5 1 1 1 0", "test.rad:2: ", "cut short");
  expectError("\nvoid plastic m 0", "test.rad:2: ", "cut short");
  expectError("void plastic", "test.rad:1: ", "cut short");
  expectError("void plastic m 0 0 5 1 nan 1 0 0", "test.rad:1: ", "'nan'");
  expectError("void plastic m 0 0 5 1\n 1e300 1 0 0", "test.rad:2: ", "1e12");
  expectError("void plastic m 0 0 5 1 inf 1 0 0", "test.rad:1: ", "'inf'");
  expectError("void plastic m 0 0 5 1 1.0x 1 0 0", "test.rad:1: ", "'1.0x'");
  expectError("void plastc m 0 0 5 1 1 1 0 0", "test.rad:1: ", "near: plastic");
  expectError("void plastic m 0 0 5 .1 .1 .1 0 0 .5\nvoid plastic n 0 0 5 1 1 1 0 0", "test.rad:2: ", "unknown type");
  expectError("void plastic m x 0 5 1 1 1 0 0", "test.rad:1: ", "no number of string arguments");
  expectError("void plastic m 0 0 99999999999999999999 1 1 1 0 0", "test.rad:1: ", "no number of real arguments");
  expectError("void plastic m 1 s 0 5 1 1 1 0 0", "test.rad:1: ", "1 string arguments, not 0");
  expectError(kGrey + "gray sphere s 0 0 4 0 0 0 1", "test.rad:2: ", "near: grey");
  expectError(kGrey + "grey polygon p 0 0 10 0 0 0 1 0 0 1 1 0 0", "test.rad:2: ", "in threes");
  expectError(kGrey + "grey polygon p 0 0 6 0 0 0 1 0 0", "test.rad:2: ", "at least 9");
  expectError(kGrey + "grey ring r 0 0 8 0 0 0 0 0 0 0 1", "test.rad:2: ", "normal is zero");
  expectError(kGrey + "grey cone k 0 0 8 0 0 0 0 0 1 -1 1", "test.rad:2: ", "different signs");
  expectError("void alias a b\nvoid alias b a\n", "test.rad:1: ", "'b'");
  expectError("void alias a a\n", "test.rad:1: ", "not defined before it");
  expectError("void antimatter hole 1 void 0 0\nhole sphere s 0 0 4 0 0 0 1", "test.rad:2: ", "antimatter");
  expectError("void plastic m 0 0 5 1.2 1 1 0 0", "test.rad:1: ", "above 1");
  expectError("void metal m 0 0 5 -.2 1 1 0 0", "test.rad:1: ", "negative");
  expectError("void light sky 0 0 3 1 1 1  sky source s 0 0 4 0 0 0 180", "test.rad:1: ", "direction is zero");
  expectError(std::string("void plastic\0m", 14), "test.rad: ", "binary");
  expectError("!rm -rf /", "test.rad:1: ", "'rm' is not evaluated here");
}

TEST(RadReader, UnusedUnsupportedMaterialsDoNoHarm) {
  EXPECT_EQ(errorOf("void antimatter hole 1 void 0 0\nvoid prism1 p 5 a b c d e 0 0\n"), "");
}

TEST(LoadScene, RefusesMixedFormats) {
  EXPECT_THROW(loadScene({"a.rad", "b.gltf"}), InputError);
  EXPECT_THROW(loadScene({}), InputError);
}

}  // namespace
}  // namespace deltalux::io::radiance::test
