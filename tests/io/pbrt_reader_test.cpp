// Scenes of pbrt, statement by statement.
#include "io/pbrt.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>
#include <deltalux/reference.hpp>

#include "io/import_file.hpp"
#include "io/spectrum.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using Counts = std::map<std::string, std::size_t>;

ImportedScene readAll(const std::string& text, const std::filesystem::path& folder = "/nonexistent") {
  ImportedScene imported = io::readPbrt(text, "scene.pbrt", folder, {});
  EXPECT_NO_THROW(validate(imported.scene));
  return imported;
}
ImportedScene read(const std::string& world) { return readAll("WorldBegin\n" + world); }

const std::string kBall = "Shape \"sphere\"\n";
const std::string kSquare =
    "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"integer indices\" [0 1 2 0 2 3]\n";

Material materialOf(const std::string& statement) { return read(statement + kBall).scene.materialOf(PrimitiveId(0)); }
Opaque opaque(const std::string& statement) { return std::get<Opaque>(materialOf(statement).surface); }
Vec3 normalOf(const std::string& world) { return std::get<Polygon>(read(world).scene.primitives[0].shape).normal; }

void expectNear(const Rgb& found, const Rgb& wanted, float tolerance = 1e-5f) {
  EXPECT_LT(glm::length(found - wanted), tolerance) << found.r << " " << found.g << " " << found.b;
}
void expectAt(const Vec3& found, const Vec3& wanted) {
  EXPECT_LT(glm::length(found - wanted), 1e-9) << found.x << " " << found.y << " " << found.z;
}

TEST(PbrtReader, BoxIsThatOfRadiance) {
  const test::TempFolder folder;
  // A room of 2 x 2 x 2 m with a lamp below its ceiling, a ball and a wall of colour: in centimetres and mirrored here.
  const auto pbrt = folder.write("box.pbrt", R"(LookAt 0 -5 1  0 0 1  0 0 1
Camera "perspective" "float fov" 40
WorldBegin
MakeNamedMaterial "white" "string type" "diffuse" "rgb reflectance" [.7 .7 .7]
MakeNamedMaterial "red" "string type" [ "diffuse" ] "rgb reflectance" [.6 .1 .05]
NamedMaterial "white"
AttributeBegin # floor and ceiling
  Scale .01 .01 .01
  Shape "bilinearmesh" "point3 P" [-100 -100 0  100 -100 0  -100 100 0  100 100 0]
  Shape "bilinearmesh" "point3 P" [-100 -100 200  -100 100 200  100 -100 200  100 100 200]
AttributeEnd
AttributeBegin # walls to the left, red, and at the back, seen from the other side of a mirror
  Scale -1 1 1
  NamedMaterial "red"
  Shape "trianglemesh" "point P" [1 -1 0  1 1 0  1 1 2  1 -1 2] "integer indices" [0 2 1 0 3 2]
  NamedMaterial "white"
  Shape "trianglemesh" "point3 P" [-1 1 0  1 1 0  1 1 2  -1 1 2] "integer indices" [0 1 2 2 3 0]
AttributeEnd
Shape "trianglemesh" "point3 P" [1 -1 0  1 -1 2  1 1 2  1 1 0] "integer indices" [0 1 2 2 3 0]
AttributeBegin
  Translate .3 .2 .4
  Shape "sphere" "float radius" .4
AttributeEnd
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [8.5 6 2] "float scale" 2
  Material "diffuse" "rgb reflectance" [0 0 0]
  Shape "trianglemesh" "point3 P" [-.3 -.3 1.9  -.3 .3 1.9  .3 .3 1.9  .3 -.3 1.9] "integer indices" [0 1 2 2 3 0]
AttributeEnd
)");
  const auto rad = folder.write("box.rad", R"(void plastic white 0 0 5 .7 .7 .7 0 0
void plastic red 0 0 5 .6 .1 .05 0 0
void light lamp 0 0 3 17 12 4
white polygon floor 0 0 12 -1 -1 0  1 -1 0  1 1 0  -1 1 0
white polygon ceiling 0 0 12 -1 -1 2  -1 1 2  1 1 2  1 -1 2
red polygon left 0 0 12 -1 -1 0  -1 1 0  -1 1 2  -1 -1 2
white polygon back 0 0 12 -1 1 0  1 1 0  1 1 2  -1 1 2
white polygon right 0 0 12 1 -1 0  1 -1 2  1 1 2  1 1 0
white sphere ball 0 0 4 .3 .2 .4 .4
lamp polygon bulb 0 0 12 -.3 -.3 1.9  -.3 .3 1.9  .3 .3 1.9  .3 -.3 1.9
)");
  const Scene scene = loadScene({pbrt}).scene, twin = loadScene({rad}).scene;
  EXPECT_EQ(scene.up, Vec3(0, 0, 1));
  ASSERT_EQ(scene.primitives.size(), twin.primitives.size());
  for (std::size_t i = 0; i < twin.primitives.size(); ++i) {
    SCOPED_TRACE(twin[twin.primitives[i].object].name);
    const Shape &shape = scene.primitives[i].shape, &other = twin.primitives[i].shape;
    EXPECT_NEAR(area(shape), area(other), 1e-9);
    expectAt(bounds(shape).lower, bounds(other).lower);
    expectAt(bounds(shape).upper, bounds(other).upper);
    const auto* polygon = std::get_if<Polygon>(&other);
    if (polygon) expectAt(std::get<Polygon>(shape).normal, polygon->normal);
    expectNear(diffuseReflectance(scene.materialOf(PrimitiveId(i)), true),
               diffuseReflectance(twin.materialOf(PrimitiveId(i)), true));
  }
  ASSERT_EQ(scene.lights.size(), 1u);
  const std::vector<ProbePoint> points{{{.5, -.5, 0}, {0, 0, 1}}, {{-.2, .3, 0}, {0, 0, 1}}, {{0, 1, 1}, {0, -1, 0}}};
  ReferenceSettings settings;
  settings.samples = 20000;
  const auto mine = ReferenceIntegrator(scene, settings).probe(points);
  const auto theirs = ReferenceIntegrator(twin, settings).probe(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_GT(gray(theirs[i].irradiance), 0.1);
    EXPECT_NEAR(gray(mine[i].irradiance) / gray(theirs[i].irradiance), 1, 0.03);
    EXPECT_NEAR(mine[i].irradiance.r / theirs[i].irradiance.r, 1, 0.03);
  }
}

TEST(PbrtReader, ShapesStandWhereTransformsPutThem) {
  const ImportedScene imported = read(R"(
    AttributeBegin Rotate 90 0 0 1 Translate 2 0 0 Shape "sphere" "float radius" [ .5 ] AttributeEnd
    TransformBegin
      Transform [ 2 0 0 0  0 2 0 0  0 0 2 0  1 2 3 1 ]
      ConcatTransform [ 1 0 0 0  0 1 0 0  0 0 1 0  1 0 0 1 ]
      CoordinateSystem "there"
      Shape "disk" "float height" 1 "float innerradius" .5
    TransformEnd
    Shape "cylinder" "float zmin" -1 "float zmax" 3 "float radius" 2
    CoordSysTransform "there"
    Shape "disk"
    Identity Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ])");
  const auto& parts = imported.scene.primitives;
  EXPECT_TRUE(imported.report.warnings.empty());
  ASSERT_EQ(parts.size(), 5u);
  expectAt(std::get<Sphere>(parts[0].shape).center, {0, 2, 0});
  const auto& ring = std::get<Ring>(parts[1].shape);
  expectAt(ring.center, {3, 2, 5});
  EXPECT_NEAR(ring.innerRadius, 1, 1e-9);
  EXPECT_NEAR(ring.outerRadius, 2, 1e-9);
  EXPECT_NEAR(area(parts[2].shape), 2 * kPi * 2 * 4, 1e-6);
  expectAt(std::get<Ring>(parts[3].shape).center, {3, 2, 3});
  EXPECT_NEAR(std::get<Polygon>(parts[4].shape).area, 1, 1e-12);
  expectAt(std::get<Polygon>(parts[4].shape).normal, {0, 0, 1});
}

TEST(PbrtReader, LookAtIsATransformOfWhatFollows) {
  expectAt(std::get<Sphere>(read("LookAt 1 2 3  1 5 3  0 0 1\n" + kBall).scene.primitives[0].shape).center,
           {1, -3, -2});
}

TEST(PbrtReader, FrontsAreTurnedByReverseOrientationAlone) {
  expectAt(normalOf(kSquare), {0, 0, 1});
  expectAt(normalOf("ReverseOrientation\n" + kSquare), {0, 0, -1});
  expectAt(normalOf("ReverseOrientation ReverseOrientation\n" + kSquare), {0, 0, 1});
  // Mirroring changes the order of corners, and which order counts.
  expectAt(normalOf("Scale -1 1 1\n" + kSquare), {0, 0, 1});
  expectAt(normalOf("Scale 1 1 -1\n" + kSquare), {0, 0, -1});
  expectAt(normalOf("Scale -1 1 1 ReverseOrientation\n" + kSquare), {0, 0, -1});
  expectAt(normalOf("AttributeBegin ReverseOrientation AttributeEnd\n" + kSquare), {0, 0, 1});
  // Normals at vertices count for more than the order.
  std::string shaded = kSquare;
  shaded.pop_back();
  shaded += " \"normal N\" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]\n";
  expectAt(normalOf(shaded), {0, 0, -1});
  expectAt(normalOf("ReverseOrientation\n" + shaded), {0, 0, 1});
  EXPECT_TRUE(std::get<Sphere>(read("ReverseOrientation\n" + kBall).scene.primitives[0].shape).inward);
}

TEST(PbrtReader, AreaLightsShineFromTheFront) {
  const std::string lamp = "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 4\n";
  const Scene one = read(lamp + "ReverseOrientation\n" + kSquare).scene;
  ASSERT_EQ(one.lights.size(), 1u);
  EXPECT_EQ(std::get<AreaLight>(one.lights[0].emitter).primitive, PrimitiveId(0));
  expectNear(one.materialOf(PrimitiveId(0)).emission->radiance, {4, 8, 12});
  EXPECT_FALSE(one.materialOf(PrimitiveId(0)).emission->bothSides);
  expectAt(std::get<Polygon>(one.primitives[0].shape).normal, {0, 0, -1});

  const Scene both = read("AreaLightSource \"diffuse\" \"bool twosided\" true\n" + kSquare).scene;
  EXPECT_TRUE(both.materialOf(PrimitiveId(0)).emission->bothSides);
  expectNear(both.materialOf(PrimitiveId(0)).emission->radiance, Rgb(1.0f));

  // 12 W of 4 m2, on one side and on two.
  for (const char* sides : {"false", "true"}) {
    const Scene powered = read("Scale 2 2 2 AreaLightSource \"diffuse\" \"float power\" 12 \"bool twosided\" " +
                               std::string(sides) + "\n" + kSquare)
                              .scene;
    expectNear(powered.materialOf(PrimitiveId(0)).emission->radiance,
               Rgb(static_cast<float>(3 / kPi / (sides[0] == 't' ? 2 : 1))));
  }
  EXPECT_TRUE(read("AreaLightSource \"diffuse\" \"rgb L\" [0 0 0]\n" + kBall).scene.lights.empty());
  EXPECT_TRUE(read("AttributeBegin " + lamp + "AttributeEnd\n" + kBall).scene.lights.empty());
}

TEST(PbrtReader, MaterialsAreThoseOfPbrt) {
  expectNear(opaque("").diffuse, Rgb(0.5f));
  expectNear(opaque("Material \"diffuse\" \"rgb reflectance\" [.1 .2 .3]\n").diffuse, {0.1f, 0.2f, 0.3f});
  const Opaque coated = opaque("Material \"coateddiffuse\" \"float roughness\" .25 \"rgb reflectance\" [.5 .5 .5]\n");
  expectNear(coated.specular.reflectance, Rgb(0.04f));
  expectNear(coated.diffuse, Rgb(0.48f));
  EXPECT_FLOAT_EQ(coated.specular.roughness, 0.5f);
  const Opaque gold = opaque(R"(Material "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" [ "metal-Au-k" ]
    "float uroughness" .2 "float vroughness" .4 "bool remaproughness" false )");
  EXPECT_GT(gold.specular.reflectance.r, 2 * gold.specular.reflectance.b);
  EXPECT_FLOAT_EQ(gold.specular.roughness, 0.3f);
  expectNear(opaque("Material \"conductor\" \"rgb eta\" [2 2 2] \"rgb k\" [3 3 3]\n").specular.reflectance,
             Rgb(10.0f / 18));
  expectNear(opaque("Material \"conductor\" \"rgb reflectance\" [.9 .8 .7]\n").specular.reflectance, {.9f, .8f, .7f});
  EXPECT_EQ(opaque("Material \"conductor\"\n").specular.roughness, 0);
  const Rgb through =
      opaque("Material \"coatedconductor\" \"rgb reflectance\" [.5 .5 .5] \"float interface.eta\" 1.5\n")
          .specular.reflectance;
  expectNear(through, Rgb(0.04f + 0.96f * 0.96f * 0.5f / 0.98f));
  EXPECT_NEAR(std::get<Dielectric>(materialOf("Material \"dielectric\" \"float eta\" 1.33\n").surface).ior, 1.33, 1e-6);
  EXPECT_NEAR(std::get<Dielectric>(materialOf("Material \"dielectric\" \"spectrum eta\" \"glass-BK7\"\n").surface).ior,
              1.5168, 1e-6);
  EXPECT_NEAR(std::get<ThinGlass>(materialOf("Material \"thindielectric\"\n").surface).ior, 1.5, 1e-6);
  const auto leaf = std::get<Trans>(
      materialOf("Material \"diffusetransmission\" \"rgb reflectance\" [.4 .4 .4] \"rgb transmittance\" [.8 .1 .1]\n")
          .surface);
  expectNear(leaf.diffuseReflectance, Rgb(0.4f));
  expectNear(leaf.diffuseTransmittance, {0.6f, 0.1f, 0.1f});
  for (const char* nothing : {"Material \"\"\n", "Material \"interface\"\n"})
    EXPECT_EQ(std::get<ThinGlass>(materialOf(nothing).surface).ior, 1);
  EXPECT_EQ(read("Material \"hair\"\n" + kBall).report.ignored, (Counts{{"material hair (gray instead)", 1}}));
}

TEST(PbrtReader, NamedMaterialsAndMixturesAreFollowed) {
  const std::string defined =
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" \"rgb reflectance\" [.2 .2 .2]\n"
      "MakeNamedMaterial \"b\" \"string type\" \"conductor\" \"rgb reflectance\" [.8 .8 .8]\n"
      "MakeNamedMaterial \"air\" \"string type\" \"interface\"\n";
  const Scene scene = read(defined + "NamedMaterial \"b\"\n" + kBall + "AttributeBegin NamedMaterial \"a\"\n" + kBall +
                           "AttributeEnd\n" + kBall)
                          .scene;
  EXPECT_EQ(scene.primitives[0].material, scene.primitives[2].material);
  EXPECT_EQ(scene.materialOf(PrimitiveId(1)).name, "a");
  const Scene later = read("NamedMaterial \"b\"\n" + kBall + defined).scene;
  expectNear(std::get<Opaque>(later.materialOf(PrimitiveId(0)).surface).specular.reflectance, Rgb(0.8f));
  const Opaque mixed = opaque(defined + "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .25\n");
  expectNear(mixed.diffuse, Rgb(0.15f));
  expectNear(mixed.specular.reflectance, Rgb(0.2f));
  const Material holes =
      materialOf(defined + "Material \"mix\" \"string materials\" [\"a\" \"air\"] \"float amount\" .3\n");
  EXPECT_NEAR(holes.coverage, 0.7, 1e-6);
  expectNear(std::get<Opaque>(holes.surface).diffuse, Rgb(0.2f));
}

TEST(PbrtReader, TexturesCountWithTheirMean) {
  const std::string uses = "Material \"diffuse\" \"texture reflectance\" \"t\"\n";
  const auto of = [&](const std::string& textures) { return opaque(textures + uses).diffuse; };
  expectNear(of("Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n"), {0.1f, 0.2f, 0.3f});
  const std::string half = "Texture \"h\" \"float\" \"constant\" \"float value\" .5\n";
  expectNear(of(half + "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"h\" \"float scale\" .5\n"), Rgb(0.25f));
  expectNear(of(half + "Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"h\" \"float amount\" .2\n"), Rgb(0.6f));
  expectNear(of("Texture \"t\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [1 1 0]\n"), {0.5f, 0.5f, 0});
  EXPECT_EQ(read("Texture \"t\" \"spectrum\" \"marble\"\n" + uses + kBall).report.ignored,
            (Counts{{"textures (average used)", 1}, {"texture marble (gray instead)", 1}}));

  const test::TempFolder folder;
  // Two texels of a TGA: blue, green, red.
  folder.write("a.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x18\0", 18) + std::string("\0\0\xff\0\0\0", 6));
  const Scene scene = readAll("WorldBegin Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.tga\"\n" +
                                  uses + "Shape \"sphere\" \"float alpha\" .25\n",
                              folder.path())
                          .scene;
  expectNear(std::get<Opaque>(scene.materialOf(PrimitiveId(0)).surface).diffuse, {0.5f, 0, 0});
  EXPECT_FLOAT_EQ(scene.materialOf(PrimitiveId(0)).coverage, 0.25f);
}

TEST(PbrtReader, SpectraBecomeColours) {
  const auto reflectance = [](const std::string& value) {
    return opaque("Material \"diffuse\" \"spectrum reflectance\" " + value + "\n").diffuse;
  };
  expectNear(reflectance("[300 .4 900 .4]"), Rgb(0.4f));
  const Rgb red = reflectance("[300 0 600 0 610 .8 900 .8]");
  EXPECT_GT(red.r, 0.5f);
  EXPECT_LT(red.g, 0.15f);
  EXPECT_LT(red.b, 0.05f);
  const auto lamp = [](const std::string& parameter) {
    return read("AreaLightSource \"diffuse\" " + parameter + " \"float scale\" 10\n" + kBall)
        .scene.materialOf(PrimitiveId(0))
        .emission->radiance;
  };
  const Rgb bulb = lamp("\"blackbody L\" 2700");
  EXPECT_NEAR(gray(bulb), 10, 1e-4);
  EXPECT_GT(bulb.r, bulb.g);
  EXPECT_GT(bulb.g, 2 * bulb.b);
  expectNear(lamp("\"blackbody L\" [6504]"), Rgb(10.0f), 1e-3f);
  expectNear(lamp("\"spectrum L\" \"stdillum-D65\""), Rgb(10.0f), 1e-3f);
  EXPECT_NEAR(gray(lamp("\"spectrum L\" [300 5 900 5]")), 10, 1e-4);
  // x .5267, y .4133 at 2000 K, and .3135, .3237 at 6504 K, as tables of black bodies have it.
  const Rgb candle = io::colourOfBlackBody(2000);
  EXPECT_NEAR(candle.g / candle.r, 0.272, 0.015);
  for (const double kelvin : {1.0, 1e-3, 1e12}) EXPECT_TRUE(std::isfinite(io::colourOfBlackBody(kelvin).r));
  const test::TempFolder folder;
  folder.write("flat.spd", "# a file of its own\n300 .3\n900 .3\n");
  expectNear(std::get<Opaque>(readAll("WorldBegin Material \"diffuse\" \"spectrum reflectance\" \"flat.spd\"\n" + kBall,
                                      folder.path())
                                  .scene.materialOf(PrimitiveId(0))
                                  .surface)
                 .diffuse,
             Rgb(0.3f));
}

TEST(PbrtReader, LightsShine) {
  const ImportedScene imported = read(kBall + R"(
    AttributeBegin Translate 1 0 0
    LightSource "point" "rgb I" [4 5 6] "point3 from" [0 2 3] "float scale" 2
    LightSource "spot" "point3 from" [0 5 0] "point3 to" [0 0 0] "float coneangle" 30 "float conedeltaangle" 10
    AttributeEnd
    LightSource "distant" "point3 from" [0 2 0] "point3 to" [0 0 0] "rgb L" [7 7 7]
    LightSource "infinite" "rgb L" [.5 .5 .5]
    LightSource "point" "float power" 100
    LightSource "infinite" "string filename" "sky.exr"
    LightSource "goniometric"
    AreaLightSource "diffuse" "string filename" "screen.exr")" +
                                      kBall);
  const Scene& scene = imported.scene;
  ASSERT_EQ(scene.lights.size(), 5u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].emitter).intensity, Rgb(8, 10, 12));
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].emitter).position, Vec3(1, 2, 3));
  const auto& spot = std::get<SpotLight>(scene.lights[1].emitter);
  expectAt(spot.direction, {0, -1, 0});
  expectAt(spot.position, {1, 5, 0});
  EXPECT_NEAR(spot.cosOuter, std::cos(kPi / 6), 1e-9);
  EXPECT_NEAR(spot.cosInner, std::cos(kPi / 9), 1e-9);
  const auto& sun = std::get<SunLight>(scene.lights[2].emitter);
  expectAt(sun.direction, {0, 1, 0});
  EXPECT_NEAR(sun.radiance.g * solidAngle(sun), 7, 1e-4);
  expectNear(skyRadiance(std::get<DomeLight>(scene.lights[3].emitter), {0, -1, 0}), Rgb(0.5f));
  EXPECT_NEAR(std::get<PointLight>(scene.lights[4].emitter).intensity.r, 100 / (4 * kPi), 1e-5);
  EXPECT_EQ(
      imported.report.ignored,
      (Counts{{"light infinite of an image", 1}, {"light goniometric", 1}, {"area light diffuse of an image", 1}}));
}

TEST(PbrtReader, CameraIsAViewAndSaysWhatIsUp) {
  const std::string film = "Film \"rgb\" \"integer xresolution\" 200 \"integer yresolution\" 100\n";
  const ImportedScene mirrored = readAll(film + "Scale -1 1 1 LookAt 1 2 3  1 5 3  0 0 1\n" +
                                         "Camera \"perspective\" \"float fov\" 60\nWorldBegin\n" + kBall);
  ASSERT_EQ(mirrored.scene.views.size(), 1u);
  const View& view = mirrored.scene.views[0];
  EXPECT_EQ(view.name, "camera0");
  expectAt(view.position, {1, 2, 3});
  expectAt(view.direction, {0, 1, 0});
  expectAt(view.up, {0, 0, 1});
  EXPECT_NEAR(view.vertical, 60, 1e-9);  // the shorter side
  EXPECT_NEAR(view.horizontal, 2 * glm::degrees(std::atan(2 * std::tan(kPi / 6))), 1e-9);
  EXPECT_EQ(mirrored.scene.up, Vec3(0, 0, 1));
  EXPECT_TRUE(mirrored.report.warnings.empty());

  const ImportedScene plain = readAll(
      "LookAt 1 2 3  1 5 3  0 0 1 Camera \"perspective\"\n"
      "Film \"rgb\" \"integer xresolution\" 100 \"integer yresolution\" 300 WorldBegin\n" +
      kBall);
  expectAt(plain.scene.views[0].direction, {0, 1, 0});
  EXPECT_NEAR(plain.scene.views[0].horizontal, 90, 1e-9);
  EXPECT_NEAR(plain.scene.views[0].vertical, 2 * glm::degrees(std::atan(3.0)), 1e-9);
  ASSERT_EQ(plain.report.warnings.size(), 1u);
  EXPECT_NE(plain.report.warnings[0].find("mirrored"), std::string::npos);

  EXPECT_EQ(readAll("Camera \"realistic\" WorldBegin\n" + kBall).report.ignored, (Counts{{"camera realistic", 1}}));
  EXPECT_EQ(read(kBall).scene.up, Vec3(0, 1, 0));
  // A lamp that the camera carries.
  const Scene carried = readAll(
                            "Translate 0 0 -5 Camera \"perspective\" WorldBegin CoordSysTransform \"camera\"\n"
                            "LightSource \"point\"\n" +
                            kBall)
                            .scene;
  EXPECT_EQ(std::get<PointLight>(carried.lights[0].emitter).position, Vec3(0, 0, 5));
}

TEST(PbrtReader, InstancesAreTheirObjectPlaced) {
  const ImportedScene imported = read(R"(Translate 1 0 0
    ObjectBegin "tree" Translate 0 1 0 Shape "sphere" AreaLightSource "diffuse" Shape "disk" ObjectEnd
    ObjectInstance "tree"
    Identity Translate 5 0 0 ObjectInstance "tree")");
  const Scene& scene = imported.scene;
  ASSERT_EQ(scene.primitives.size(), 4u);
  expectAt(std::get<Sphere>(scene.primitives[0].shape).center, {2, 1, 0});
  expectAt(std::get<Sphere>(scene.primitives[2].shape).center, {6, 1, 0});
  EXPECT_EQ(scene[scene.primitives[3].object].name, "tree/1");
  EXPECT_EQ(primitivesOf(scene, findObjects(scene, "tree")[0]).size(), 4u);
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_EQ(imported.report.ignored, (Counts{{"area lights of instances", 1}}));
}

TEST(PbrtReader, AttributesAreDefaults) {
  const Scene scene = read(R"(AttributeBegin
    Attribute "shape" "float radius" 3
    Attribute "material" "rgb reflectance" [.1 .1 .1]
    Material "diffuse" Shape "sphere" Shape "sphere" "float radius" 2
    AttributeEnd Shape "sphere")")
                          .scene;
  EXPECT_EQ(std::get<Sphere>(scene.primitives[0].shape).radius, 3);
  EXPECT_EQ(std::get<Sphere>(scene.primitives[1].shape).radius, 2);
  EXPECT_EQ(std::get<Sphere>(scene.primitives[2].shape).radius, 1);
  expectNear(std::get<Opaque>(scene.materialOf(PrimitiveId(0)).surface).diffuse, Rgb(0.1f));
}

TEST(PbrtReader, WhatIsNotReadIsCountedOrPassedOver) {
  const ImportedScene imported = readAll(R"(Option "bool disablepixeljitter" true
    Sampler "halton" "integer pixelsamples" 128 Integrator "volpath" PixelFilter "box" Accelerator "bvh"
    ColorSpace "rec2020" TransformTimes 0 1
    MakeNamedMedium "fog" "string type" "homogeneous" MediumInterface "" "fog"
    WorldBegin MediumInterface "fog"
    AttributeBegin ActiveTransform EndTime Translate 9 9 9 ActiveTransform All Shape "sphere" AttributeEnd
    Shape "sphere" "float phimax" 90
    Shape "loopsubdiv" "point3 P" []
    AttributeBegin Scale 1 2 1 Shape "sphere" AttributeEnd)");
  EXPECT_EQ(imported.scene.primitives.size(), 1u);
  EXPECT_EQ(std::get<Sphere>(imported.scene.primitives[0].shape).center, Vec3(0));
  EXPECT_EQ(imported.report.ignored, (Counts{{"colour spaces (numbers as they stand)", 1},
                                             {"media", 1},
                                             {"motion (as it starts)", 1},
                                             {"shape loopsubdiv", 1},
                                             {"shape sphere (partial)", 1},
                                             {"shapes that are sheared or flattened", 1}}));
  EXPECT_EQ(imported.report.surfaces, (Counts{{"sphere", 1}}));
  // Bent patches are two triangles.
  const ImportedScene bent = read("Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]\n");
  EXPECT_EQ(bent.report.ignored, (Counts{{"bends of bilinear patches (two triangles each)", 1}}));
}

TEST(PbrtReader, FilesBesideItAreRead) {
  const test::TempFolder folder;
  folder.write("square.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  folder.write("more.pbrt", "Scale 3 3 3\n");
  const auto file = folder.write("scene.pbrt",
                                 "WorldBegin\r\nImport \"more.pbrt\"\r\nShape \"plymesh\" \"string filename\" "
                                 "\"square.ply\"\r\nInclude \"more.pbrt\"\r\nShape \"plymesh\" \"string filename\" "
                                 "[ \"square.ply\" ]\r\n");
  const Scene scene = loadScene({file}).scene;
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_NEAR(area(scene.primitives[0].shape), 1, 1e-9);
  EXPECT_NEAR(area(scene.primitives[1].shape), 9, 1e-9);
  EXPECT_EQ(scene[scene.primitives[0].object].name, "square");
}

TEST(PbrtReader, TextInQuotesHasItsEscapes) {
  const Scene scene = read(
                          "MakeNamedMaterial \"a \\\"b\\\" # c\" \"string type\" \"diffuse\" # \"and\" [ so on\n"
                          "NamedMaterial \"a \\\"b\\\" # c\"" +
                          kBall)
                          .scene;
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "a \"b\" # c");
}

void expectError(const std::string& text, int line, const std::string& words,
                 const std::filesystem::path& folder = "/nonexistent", const std::string& file = "scene.pbrt") {
  try {
    io::readPbrt(text, "scene.pbrt", folder, {});
    ADD_FAILURE() << "was read: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(error.message().find(words), std::string::npos) << error.message() << " of " << text;
    EXPECT_EQ(error.line(), line) << error.message();
    EXPECT_EQ(std::filesystem::path(error.file()).filename(), file);
    EXPECT_FALSE(error.hint().empty());
  }
}

TEST(PbrtReader, MistakesAreInputErrorsWithTheirLine) {
  const auto expect = [](const std::string& world, int line, const std::string& words) {
    expectError("WorldBegin\n" + world, line, words);
  };
  expectError("", 0, "no WorldBegin");
  expectError(kBall, 1, "before WorldBegin");
  expectError("LookAt 0 0 0 0 0 0 0 1 0\nWorldBegin", 1, "where it stands");
  expectError("Scale 0 1 1 Camera \"perspective\"\nWorldBegin", 1, "flatten");
  expectError("\xff\xfe\x01", 0, "UTF-16");
  expect("", 0, "no shape");
  expect("\n\nshape \"sphere\"", 4, "'shape' is no statement");
  expect("Camera \"perspective\"", 2, "behind WorldBegin");
  expect("AttributeBegin\n" + kBall, 2, "has no end");
  expect(kBall + "AttributeEnd", 3, "not begun");
  expect("AttributeBegin TransformEnd", 2, "not begun");
  expect("Translate 1 2\nShape", 3, "not a number");
  expect("Scale 1 [", 2, "a number should stand");
  expect("Transform [1 2 3]", 2, "a number should stand");
  expect("Transform [1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1]", 2, "projection");
  expect("Rotate 30 0 0 0", 2, "axis");
  expect("Scale 1e9 1 1\nScale 1e9 1 1", 3, "overflow");
  expect("Shape \"sphere\" \"float radius\" big", 2, "not a number");
  expect("Shape \"sphere\" \"float radius\" 1e99", 2, "too large");
  expect("Shape \"sphere\" \"float radius\" [1\n2]", 2, "not one value");
  expect("Shape \"sphere\" \"float radius\" [1 [2]]", 2, "within a list");
  expect("Shape \"sphere\" \"float radius\" [1\n", 3, "the file ends");
  expect("Shape \"sphere\" \"float radius\" 0", 2, "radius");
  expect("Shape \"sphere\" \"string radius\" \"2\"", 2, "type that it cannot have");
  expect("Shape \"sphere\" \"real radius\" 2", 2, "no type and name");
  expect("Shape \"sphere\" \"float\" 2", 2, "no type and name");
  expect("Shape \"sph\nere\"", 2, "does not end in its line");
  expect("Shape \"\\q\"", 2, "escape");
  expect("Shape \"sphere\" \"bool a\" maybe", 2, "in quotes");
  expect("Shape \"sphere\" \"integer a\" 1.5", 2, "no integer");
  expect("Shape \"trianglemesh\"", 2, "no vertices");
  expect("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 1 1 2 2 0 1 2 3]", 2, "no indices");
  expect("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 1]", 2, "as many numbers");
  expect("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0]\n\"integer indices\" [0 1 3]", 3, "not there");
  expect("Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0]\n\"integer indices\" [0 1 -1]", 3, "not there");
  expect("Shape \"plymesh\"", 2, "names no file");
  expect("Shape \"plymesh\" \"string filename\" \"../../etc/passwd\"", 2, "outside");
  expect("Material \"diffuse\" \"texture reflectance\" \"t\"\n" + kBall, 2, "'t' is not defined");
  expect(
      "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\"\nMaterial \"diffuse\" \"texture reflectance\" "
      "\"t\"\n" +
          kBall,
      2, "without an end");
  expect("MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string materials\" [\"m\" \"m\"]\nNamedMaterial \"m\"\n" +
             kBall,
         2, "without an end");
  expect("\nNamedMaterial \"m\"\n" + kBall, 3, "'m' is not defined");
  expect("Material \"diffuse\" \"rgb reflectance\" [.1 -.2 .3]\n" + kBall, 2, "negative");
  expect("Material \"diffuse\" \"spectrum reflectance\" [500 1 400 1]\n" + kBall, 2, "ascend");
  expect("Material \"dielectric\" \"float eta\" 0\n" + kBall, 2, "out of range");
  expect("AreaLightSource \"diffuse\" \"blackbody L\" -1\n" + kBall, 2, "temperature");
  expect("LightSource \"distant\" \"point3 from\" [1 1 1] \"point3 to\" [1 1 1]", 2, "nowhere");
  expect("ObjectInstance \"a\"", 2, "'a' is not defined");
  expect("ObjectBegin \"a\"\nObjectBegin \"b\"", 3, "within another");
  expect("ObjectBegin \"a\"\nObjectInstance \"a\"", 3, "within an object");
  expect("CoordSysTransform \"a\"", 2, "'a' is not there");
  expect("Attribute \"camera\" \"float a\" 1", 2, "no attributes");
}

TEST(PbrtReader, IncludesAreBoundedAndErrorsNameTheirFile) {
  const test::TempFolder folder;
  folder.write("loop.pbrt", "# a loop\nInclude \"loop.pbrt\"\n");
  expectError("WorldBegin\nInclude \"loop.pbrt\"\n", 2, "too deeply", folder.path(), "loop.pbrt");
  folder.write("wrong.pbrt", "Shape \"sphere\"\n\nShape \"sphere\" \"float radius\" none\n");
  expectError("WorldBegin\nInclude \"wrong.pbrt\"\n", 3, "not a number", folder.path(), "wrong.pbrt");
  expectError("WorldBegin\nInclude \"none.pbrt\"\n", 0, "no such file", folder.path(), "none.pbrt");
  expectError("WorldBegin\n\nInclude \"../a.pbrt\"\n", 3, "outside", folder.path());
}

TEST(PbrtReader, CasesOfTheFuzzerAreReadOrRefused) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus/pbrt")) {
    ++count;
    try {
      validate(io::readPbrt(io::readInputFile(entry.path()), entry.path().string(), "/nonexistent", {}).scene);
    } catch (const InputError& error) {
      EXPECT_FALSE(error.message().empty());
    }
  }
  EXPECT_GE(count, 2u);
}

}  // namespace
}  // namespace deltalux
