// Patterns and mixtures on what reflects: their values at places, and what is said of those that cannot be read.
#include <gtest/gtest.h>

#include "io/image/formats.hpp"
#include "io/radiance/memory_files.hpp"
#include "scene/texture_tint.hpp"

namespace deltalux::io::radiance::test {
namespace {

const char* const kPlastic = "void plastic white 0 0 5 .5 .5 .5 0 0\n";
/// A rectangle of 2 x 1 in z = 0.
std::string sheet(const std::string& modifier) {
  return modifier + " polygon sheet 0 0 12  0 0 0  2 0 0  2 1 0  0 1 0\n";
}

/// The diffuse colour at a place of the first primitive.
Rgb colourAt(const Scene& scene, double x, double y) {
  const PrimitiveId id(0);
  const Rgb diffuse = std::get<Opaque>(scene.materialOf(id).surface).diffuse;
  const auto* mesh = std::get_if<Mesh>(&scene[id].shape);
  if (!mesh) return diffuse;
  for (std::uint32_t t = 0; t < mesh->triangles.size(); ++t) {
    const auto& corners = mesh->triangles[t];
    const Vec3 &a = mesh->positions[corners[0]], &b = mesh->positions[corners[1]], &c = mesh->positions[corners[2]];
    const auto side = [&](const Vec3& p, const Vec3& q) { return (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x); };
    if (side(a, b) >= 0 && side(b, c) >= 0 && side(c, a) >= 0)
      return diffuse * scene::textureTint(scene, id, t, {x, y, 0});
  }
  return Rgb(-1.0f);
}

void expectColour(const Rgb& found, const Rgb& wanted, double within = 1e-4) {
  EXPECT_LT(glm::length(found - wanted), within) << found.r << " " << found.g << " " << found.b;
}

TEST(SurfacePatterns, BrightnessRunsOverAPolygon) {
  const ImportedScene imported =
      read("void brightfunc ramp 2 r ramp.cal 0 1 .5\nramp plastic white 0 0 5 .5 .4 .2 .1 0\n" + sheet("white"),
           {{"ramp.cal", "r = A1 * Px;"}});
  EXPECT_TRUE(imported.report.warnings.empty());
  EXPECT_NO_THROW(validate(imported.scene));
  ASSERT_EQ(imported.scene.primitives.size(), 1u);
  EXPECT_NEAR(area(imported.scene.primitives[0].shape), 2, 1e-9);
  for (const auto& [x, y] : {std::pair(0.1, 0.1), {1.0, 0.5}, {1.9, 0.9}, {0.6, 0.95}})
    expectColour(colourAt(imported.scene, x, y), Rgb(0.45f, 0.36f, 0.18f) * float(0.5 * x));
  // Plastic's gloss keeps its own.
  expectColour(std::get<Opaque>(imported.scene.materialOf(PrimitiveId(0)).surface).specular.reflectance, Rgb(0.1f),
               1e-6);
}

TEST(SurfacePatterns, ColoursFollowTheirTransform) {
  const ImportedScene imported =
      read("void colorfunc stripes 10 r g b s.cal -rz 90 -t 1 0 0\n0 0\nstripes plastic white 0 0 5 1 1 1 0 0\n" +
               sheet("white"),
           {{"s.cal", "r = Px / 2; g = 1 - Px / 2; b = -Py / 4 + .25;"}});
  EXPECT_TRUE(imported.report.warnings.empty());
  // Its x is the scene's y, its y the scene's 1 - x.
  expectColour(colourAt(imported.scene, 1.2, 0.6), Rgb(0.3f, 0.7f, 0.3f));
}

TEST(SurfacePatterns, WhatIsTheSameEverywhereKeepsTheShape) {
  const ImportedScene imported = read(
      "void colorfunc tint 4 r g b . 0 0\ntint plastic white 0 0 5 .5 .5 .5 0 0\n" + sheet("white") + sheet("white"),
      {});
  EXPECT_FALSE(imported.report.warnings.empty());  // r is not defined
  const ImportedScene flat = read(
      "void brightfunc half 2 h h.cal 0 0\nhalf metal white 0 0 5 .5 .5 .5 .4 .1\n" + sheet("white") + sheet("white"),
      {{"h.cal", "h = .5;"}});
  EXPECT_TRUE(flat.report.warnings.empty());
  EXPECT_TRUE(std::holds_alternative<Polygon>(flat.scene.primitives[0].shape));
  EXPECT_EQ(flat.scene.primitives[0].material, flat.scene.primitives[1].material);
  const Opaque& metal = std::get<Opaque>(flat.scene.materialOf(PrimitiveId(0)).surface);
  expectColour(metal.diffuse, Rgb(0.15f));
  expectColour(metal.specular.reflectance, Rgb(0.1f));
}

TEST(SurfacePatterns, PicturesLieOnSurfaces) {
  Image image;
  image.width = 8, image.height = 4;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) image.pixels.emplace_back(x < 4 ? 1.0f : 0.25f, y < 2 ? 1.0f : 0.25f, 0.5f);
  image.exposure = 1;
  const std::map<std::string, std::string> files{{"p.hdr", encodeHdr(image)}};
  const ImportedScene imported = read(
      "void colorpict poster 7 red green blue p.hdr picture.cal pic_u pic_v 0 1 .5\nposter plastic white 0 0 5 .8 .8 "
      ".8 0 0\n" +
          sheet("white"),
      files);
  EXPECT_TRUE(imported.report.warnings.empty());
  expectColour(colourAt(imported.scene, 0.5, 0.25), Rgb(0.8f, 0.2f, 0.4f), 0.01);  // lower left
  expectColour(colourAt(imported.scene, 1.5, 0.75), Rgb(0.2f, 0.8f, 0.4f), 0.01);  // upper right
  const ImportedScene missing = read(
      "void colorpict poster 7 red green blue q.hdr picture.cal pic_u pic_v 0 0\nposter plastic white 0 0 5 .8 .8 .8 0 "
      "0\n" +
      sheet("white"));
  ASSERT_EQ(missing.report.warnings.size(), 1u);
  EXPECT_NE(missing.report.warnings[0].find("q.hdr"), std::string::npos);
  expectColour(colourAt(missing.scene, 0.5, 0.25), Rgb(0.8f));
}

TEST(SurfacePatterns, MixturesAreMixed) {
  const std::string paints = "void plastic red 0 0 5 .8 0 0 0 0\nvoid plastic blue 0 0 5 0 0 .4 .2 0\n";
  const ImportedScene imported =
      read(paints + "void mixfunc both 4 red blue share m.cal 0 0\n" + sheet("both"), {{"m.cal", "share = Px / 2;"}});
  EXPECT_TRUE(imported.report.warnings.empty());
  expectColour(colourAt(imported.scene, 0.5, 0.5), 0.25f * Rgb(0.8f, 0, 0) + 0.75f * Rgb(0, 0, 0.32f));
  expectColour(colourAt(imported.scene, 1.8, 0.2), 0.9f * Rgb(0.8f, 0, 0) + 0.1f * Rgb(0, 0, 0.32f));
  // Of glass and plastic the first counts, and it is said.
  const ImportedScene glass = read("void glass g 0 0 3 .9 .9 .9\n" + std::string(kPlastic) +
                                       "void mixfunc both 4 g white share m.cal 0 0\n" + sheet("both"),
                                   {{"m.cal", "share = .5;"}});
  EXPECT_TRUE(std::holds_alternative<ThinGlass>(glass.scene.materialOf(PrimitiveId(0)).surface));
  EXPECT_EQ(glass.report.ignored.at("mixfunc"), 1u);
}

TEST(SurfacePatterns, OnCurvedSurfacesTheMeanCounts) {
  const ImportedScene imported = read(
      "void brightfunc ramp 2 r ramp.cal 0 0\nramp plastic white 0 0 5 .5 .5 .5 0 0\nwhite sphere ball 0 0 4 0 0 0 1\n",
      {{"ramp.cal", "r = (1 + Pz) / 2;"}});
  EXPECT_NEAR(std::get<Opaque>(imported.scene.materialOf(PrimitiveId(0)).surface).diffuse.g, 0.25, 0.01);
  EXPECT_EQ(imported.report.ignored.at("patterns over curved surfaces (average used)"), 1u);
}

TEST(SurfacePatterns, NothingReflectsMoreThanArrives) {
  const ImportedScene imported =
      read("void brightfunc loud 2 r r.cal 0 0\nloud plastic white 0 0 5 .5 .5 .5 .3 0\n" + sheet("white"),
           {{"r.cal", "r = 9 * Px;"}});
  EXPECT_NO_THROW(validate(imported.scene));
  expectColour(colourAt(imported.scene, 1.5, 0.5), Rgb(0.7f));
  const ImportedScene bad =
      read("void brightfunc loud 2 r r.cal 0 0\nloud plastic white 0 0 5 .5 .5 .5 0 0\n" + sheet("white"),
           {{"r.cal", "r = 1 / (Px - Px);"}});
  EXPECT_EQ(bad.report.warnings.size(), 1u);
  expectColour(colourAt(bad.scene, 1.5, 0.5), Rgb(0.5f));
}

}  // namespace
}  // namespace deltalux::io::radiance::test
