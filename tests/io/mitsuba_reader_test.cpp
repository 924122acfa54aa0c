// Scenes of Mitsuba's, plugin by plugin.
#include "io/mitsuba.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/error.hpp>

#include "io/import_file.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

ImportedScene read(const std::string& inner) {
  return io::readMitsuba("<scene version=\"3.0.0\">\n" + inner + "</scene>\n", "scene.xml", "/nonexistent", {});
}
const std::string kBall = "<shape type=\"sphere\"/>\n";
std::string ballOf(const std::string& bsdf) { return "<shape type=\"sphere\">" + bsdf + "</shape>\n"; }
Material materialOf(const std::string& bsdf) { return read(ballOf(bsdf)).scene.materialOf(PrimitiveId(0)); }

void expectNear(const Rgb& found, const Rgb& wanted) {
  EXPECT_LT(glm::length(found - wanted), 1e-5) << found.r << " " << found.g << " " << found.b;
}

TEST(MitsubaReader, ShapesStandWhereTheirTransformsPutThem) {
  const ImportedScene imported = read(R"(
    <shape type="rectangle" id="floor"><transform name="to_world"><scale x="2" y="3"/><rotate x="1" angle="-90"/>
      <translate y="1"/></transform></shape>
    <shape type="sphere"><point name="center" x="1" y="2" z="3"/><float name="radius" value="0.5"/>
      <transform name="toWorld"><scale value="2"/></transform></shape>
    <shape type="cylinder"><point name="p0" x="0" y="0" z="0"/><point name="p1" x="0" y="4" z="0"/><float name="radius" value="2"/></shape>
    <shape type="disk"><transform name="to_world"><matrix value="1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1"/></transform></shape>
    <shape type="cube"/>)");
  const Scene& scene = imported.scene;
  EXPECT_NO_THROW(validate(scene));
  EXPECT_TRUE(imported.report.warnings.empty());
  ASSERT_EQ(scene.primitives.size(), 4u + 6u);
  const auto& floor = std::get<Polygon>(scene.primitives[0].shape);
  EXPECT_NEAR(floor.area, 24, 1e-9);
  EXPECT_NEAR(glm::length(floor.normal - Vec3(0, 1, 0)), 0, 1e-9);
  EXPECT_NEAR(bounds(scene.primitives[0].shape).upper.z, 3, 1e-9);
  EXPECT_EQ(scene[scene.primitives[0].object].name, "floor");
  EXPECT_NEAR(glm::length(std::get<Sphere>(scene.primitives[1].shape).center - Vec3(2, 4, 6)), 0, 1e-9);
  EXPECT_NEAR(std::get<Sphere>(scene.primitives[1].shape).radius, 1, 1e-9);
  EXPECT_NEAR(area(scene.primitives[2].shape), 2 * kPi * 2 * 4, 1e-6);
  EXPECT_NEAR(std::get<Ring>(scene.primitives[3].shape).center.x, 5, 1e-9);
  for (std::size_t i = 4; i < 10; ++i) {
    const auto& face = std::get<Polygon>(scene.primitives[i].shape);
    EXPECT_NEAR(face.area, 4, 1e-9);
    EXPECT_GT(glm::dot(face.normal, face.vertices[0]), 0.9);  // outwards
  }
}

TEST(MitsubaReader, NormalsAreFlipped) {
  const Scene scene = read(
                          "<shape type=\"rectangle\"><boolean name=\"flip_normals\" value=\"true\"/></shape>"
                          "<shape type=\"sphere\"><boolean name=\"flipNormals\" value=\"true\"/></shape>")
                          .scene;
  EXPECT_NEAR(std::get<Polygon>(scene.primitives[0].shape).normal.z, -1, 1e-9);
  EXPECT_TRUE(std::get<Sphere>(scene.primitives[1].shape).inward);
}

TEST(MitsubaReader, MaterialsAreTheirBsdfs) {
  const auto opaque = [](const std::string& bsdf) { return std::get<Opaque>(materialOf(bsdf).surface); };
  expectNear(opaque(R"(<bsdf type="diffuse"><rgb name="reflectance" value="0.1, 0.2, 0.3"/></bsdf>)").diffuse,
             {0.1f, 0.2f, 0.3f});
  expectNear(
      opaque(R"(<bsdf type="twosided"><bsdf type="diffuse"><spectrum name="reflectance" value="0.4"/></bsdf></bsdf>)")
          .diffuse,
      Rgb(0.4f));
  expectNear(opaque(R"(<bsdf type="diffuse"/>)").diffuse, Rgb(0.5f));
  const Opaque gold = opaque(
      R"(<bsdf type="roughconductor"><string name="material" value="Au"/><float name="alpha" value="0.3"/></bsdf>)");
  EXPECT_FLOAT_EQ(gold.specular.roughness, 0.3f);
  EXPECT_GT(gold.specular.reflectance.r, 2 * gold.specular.reflectance.b);
  EXPECT_TRUE(isBlack(gold.diffuse));
  const Opaque mirror = opaque(R"(<bsdf type="conductor"><string name="material" value="none"/></bsdf>)");
  EXPECT_EQ(mirror.specular.roughness, 0);
  expectNear(mirror.specular.reflectance, Rgb(1.0f));
  const Opaque metal = opaque(R"(<bsdf type="conductor"><rgb name="eta" value="2"/><rgb name="k" value="3"/></bsdf>)");
  expectNear(metal.specular.reflectance, Rgb(10.0f / 18));
  const Opaque plastic = opaque(
      R"(<bsdf type="plastic"><float name="int_ior" value="1.5"/><string name="ext_ior" value="vacuum"/><rgb name="diffuse_reflectance" value="0.5"/></bsdf>)");
  expectNear(plastic.specular.reflectance, Rgb(0.04f));
  expectNear(plastic.diffuse, Rgb(0.48f));
  EXPECT_NEAR(
      std::get<Dielectric>(
          materialOf(
              R"(<bsdf type="dielectric"><string name="int_ior" value="water"/><string name="ext_ior" value="vacuum"/></bsdf>)")
              .surface)
          .ior,
      1.333, 1e-5);
  EXPECT_TRUE(std::holds_alternative<ThinGlass>(materialOf("<bsdf type=\"thindielectric\"/>").surface));
  EXPECT_FLOAT_EQ(
      materialOf(R"(<bsdf type="mask"><float name="opacity" value="0.3"/><bsdf type="diffuse"/></bsdf>)").coverage,
      0.3f);
  expectNear(
      opaque(
          R"(<bsdf type="diffuse"><texture type="checkerboard" name="reflectance"><rgb name="color0" value="1"/><rgb name="color1" value="0.5"/></texture></bsdf>)")
          .diffuse,
      Rgb(0.75f));
}

TEST(MitsubaReader, ReferencesAndDefaultsAreFollowed) {
  const Scene scene =
      read(R"(<default name="r" value="3"/><bsdf type="diffuse" id="paint"><rgb name="reflectance" value="0.2"/></bsdf>
    <shape type="sphere" id="one"><float name="radius" value="$r"/><ref id="paint"/></shape>
    <shape type="sphere"><ref name="bsdf" id="paint"/></shape>)")
          .scene;
  EXPECT_EQ(std::get<Sphere>(scene.primitives[0].shape).radius, 3);
  EXPECT_EQ(scene.primitives[0].material, scene.primitives[1].material);
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "paint");
}

TEST(MitsubaReader, InstancesAreTheirGroupPlaced) {
  const Scene scene = read(R"(<shape type="shapegroup" id="g"><shape type="sphere"/><shape type="disk"/></shape>
    <shape type="instance"><ref id="g"/><transform name="to_world"><translate x="3"/></transform></shape>
    <shape type="instance"><ref id="g"/></shape>)")
                          .scene;
  ASSERT_EQ(scene.primitives.size(), 4u);
  EXPECT_EQ(std::get<Sphere>(scene.primitives[0].shape).center, Vec3(3, 0, 0));
  EXPECT_EQ(std::get<Sphere>(scene.primitives[2].shape).center, Vec3(0));
}

TEST(MitsubaReader, EmittersShine) {
  const ImportedScene imported = read(
      kBall +
      R"(<emitter type="point"><point name="position" x="1" y="2" z="3"/><rgb name="intensity" value="4 5 6"/></emitter>
    <emitter type="spot"><transform name="to_world"><lookat origin="0 5 0" target="0 0 0" up="0 0 1"/></transform><rgb name="intensity" value="2"/><float name="cutoff_angle" value="30"/></emitter>
    <emitter type="directional"><vector name="direction" x="0" y="-2" z="0"/><rgb name="irradiance" value="7"/></emitter>
    <emitter type="constant"><rgb name="radiance" value="0.5"/></emitter>
    <emitter type="envmap"><string name="filename" value="x.exr"/></emitter>
    <shape type="disk"><emitter type="area"><rgb name="radiance" value="9, 8, 7"/></emitter></shape>)");
  const Scene& scene = imported.scene;
  EXPECT_NO_THROW(validate(scene));
  ASSERT_EQ(scene.lights.size(), 5u);
  EXPECT_EQ(std::get<PointLight>(scene.lights[0].emitter).intensity, Rgb(4, 5, 6));
  const auto& spot = std::get<SpotLight>(scene.lights[1].emitter);
  EXPECT_NEAR(spot.direction.y, -1, 1e-9);
  EXPECT_EQ(spot.position, Vec3(0, 5, 0));
  EXPECT_NEAR(spot.cosOuter, std::cos(kPi / 6), 1e-9);
  const auto& sun = std::get<SunLight>(scene.lights[2].emitter);
  EXPECT_NEAR(sun.direction.y, 1, 1e-9);
  EXPECT_NEAR(sun.radiance.g * solidAngle(sun), 7, 1e-4);
  expectNear(skyRadiance(std::get<DomeLight>(scene.lights[3].emitter), {0, -1, 0}), Rgb(0.5f));
  expectNear(scene.materialOf(PrimitiveId(1)).emission->radiance, {9, 8, 7});
  EXPECT_EQ(imported.report.ignored, (std::map<std::string, std::size_t>{{"emitter envmap", 1}}));
}

TEST(MitsubaReader, SensorsAreViewsAndSayWhatIsUp) {
  const std::string sensor = R"(<sensor type="perspective"><float name="fov" value="60"/><transform name="to_world">
    <lookat origin="1 2 3" target="1 5 3" up="0 0 1"/></transform><film type="hdrfilm"><integer name="width" value="200"/>
    <integer name="height" value="100"/></film></sensor>)";
  const Scene scene = read(kBall + sensor).scene;
  ASSERT_EQ(scene.views.size(), 1u);
  EXPECT_EQ(scene.views[0].position, Vec3(1, 2, 3));
  EXPECT_NEAR(glm::length(scene.views[0].direction - Vec3(0, 1, 0)), 0, 1e-9);
  EXPECT_NEAR(scene.views[0].horizontal, 60, 1e-9);
  EXPECT_NEAR(scene.views[0].vertical, 2 * glm::degrees(std::atan(std::tan(kPi / 6) / 2)), 1e-9);
  EXPECT_EQ(scene.up, Vec3(0, 0, 1));
  EXPECT_EQ(read(kBall).scene.up, Vec3(0, 1, 0));
}

TEST(MitsubaReader, FilesBesideItAreRead) {
  const test::TempFolder folder;
  folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  folder.write("more.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/></scene>");
  const auto file = folder.write("scene.xml", R"(<scene version="3.0.0"><include filename="more.xml"/>
    <shape type="obj"><string name="filename" value="square.obj"/><transform name="to_world"><scale value="3"/></transform></shape></scene>)");
  const Scene scene = loadScene({file}).scene;
  ASSERT_EQ(scene.primitives.size(), 2u);
  EXPECT_NEAR(area(scene.primitives[0].shape), 9, 1e-9);
}

TEST(MitsubaReader, MistakesAreInputErrorsWithTheirLine) {
  const auto expect = [](const std::string& inner, int line, const std::string& words) {
    try {
      read(inner);
      ADD_FAILURE() << "was read: " << inner;
    } catch (const InputError& error) {
      EXPECT_NE(error.message().find(words), std::string::npos) << error.message();
      EXPECT_EQ(error.line(), line) << error.message();
      EXPECT_FALSE(error.hint().empty());
    }
  };
  expect("", 0, "no shape");
  expect("<shape type=\"sphere\">\n<float name=\"radius\" value=\"big\"/></shape>", 3, "not a number");
  expect("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>", 2, "radius");
  expect(kBall + "<shape type=\"sphere\"><ref id=\"none\"/></shape>", 3, "'none'");
  expect("<bsdf type=\"twosided\" id=\"a\"><ref id=\"a\"/></bsdf>\n<shape type=\"sphere\"><ref id=\"a\"/></shape>", 2,
         "without an end");
  expect(
      "<shape type=\"shapegroup\" id=\"g\"><shape type=\"instance\"><ref id=\"g\"/></shape></shape>\n<shape "
      "type=\"instance\"><ref id=\"g\"/></shape>",
      2, "contain each other");
  expect("<shape type=\"obj\"/>", 2, "names no file");
  expect("<shape type=\"obj\"><string name=\"filename\" value=\"../../etc/passwd\"/></shape>", 2, "");
  EXPECT_THROW(io::readMitsuba("<scene", "scene.xml", "/", {}), InputError);
  EXPECT_THROW(io::readMitsuba("<IESTM33/>", "scene.xml", "/", {}), InputError);
}

TEST(MitsubaReader, CasesOfTheFuzzerAreReadOrRefused) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus/mitsuba")) {
    ++count;
    try {
      validate(io::readMitsuba(io::readInputFile(entry.path()), entry.path().string(), "/nonexistent", {}).scene);
    } catch (const InputError& error) {
      EXPECT_FALSE(error.message().empty());
    }
  }
  EXPECT_GE(count, 2u);
}

}  // namespace
}  // namespace deltalux
