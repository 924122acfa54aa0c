#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"

namespace deltalux::io::radiance::test {
namespace {

Material materialOf(const std::string& definition) { return read(definition).scene.materials.back(); }

void expectNear(const Rgb& a, const Rgb& b) { EXPECT_LT(glm::length(a - b), 1e-6f) << a.r << " " << a.g << " " << a.b; }

TEST(RadMaterials, PlasticsLobeIsUncoloured) {
  const auto plastic = std::get<Opaque>(materialOf("void plastic m 0 0 5 .5 .4 .2 .1 .05").surface);
  expectNear(plastic.diffuse, {0.45f, 0.36f, 0.18f});
  expectNear(plastic.specular.reflectance, Rgb(0.1f));
  EXPECT_FLOAT_EQ(plastic.specular.roughness, 0.05f);
}

TEST(RadMaterials, MetalsLobeIsColoured) {
  const auto metal = std::get<Opaque>(materialOf("void metal m 0 0 5 .5 .4 .2 .75 .1").surface);
  expectNear(metal.diffuse, {0.125f, 0.1f, 0.05f});
  expectNear(metal.specular.reflectance, {0.375f, 0.3f, 0.15f});
  const auto metal2 = std::get<Opaque>(materialOf("void metal2 m 4 ux uy uz . 0 6 .5 .4 .2 .75 .1 .3").surface);
  EXPECT_FLOAT_EQ(metal2.specular.roughness, 0.2f);
  expectNear(metal2.specular.reflectance, metal.specular.reflectance);
}

TEST(RadMaterials, TransSplitsWhatItsSurfaceDoesNotReflect) {
  const auto trans = std::get<Trans>(materialOf("void trans m 0 0 7 .8 .6 .4 .1 .02 .5 .25").surface);
  expectNear(trans.reflection.reflectance, Rgb(0.1f));
  expectNear(trans.diffuseReflectance, 0.45f * Rgb(0.8f, 0.6f, 0.4f));
  expectNear(trans.diffuseTransmittance, 0.45f * 0.75f * Rgb(0.8f, 0.6f, 0.4f));
  expectNear(trans.transmission.reflectance, 0.45f * 0.25f * Rgb(0.8f, 0.6f, 0.4f));
}

TEST(RadMaterials, GlassDielectricAndMirror) {
  const auto glass = std::get<ThinGlass>(materialOf("void glass m 0 0 3 .96 .9 .8").surface);
  expectNear(glass.transmissivity, {0.96f, 0.9f, 0.8f});
  EXPECT_FLOAT_EQ(glass.ior, 1.52f);
  EXPECT_FLOAT_EQ(std::get<ThinGlass>(materialOf("void glass m 0 0 4 1 1 1 1.4").surface).ior, 1.4f);
  const auto dielectric = std::get<Dielectric>(materialOf("void dielectric m 0 0 5 .9 .8 .7 1.5 0").surface);
  expectNear(dielectric.transmission, {0.9f, 0.8f, 0.7f});
  EXPECT_FLOAT_EQ(dielectric.ior, 1.5f);
  expectNear(std::get<Mirror>(materialOf("void mirror m 0 0 3 .9 .8 .7").surface).reflectance, {0.9f, 0.8f, 0.7f});
}

TEST(RadMaterials, AlternatesOfMirrorAndIllum) {
  const std::string glass = "void glass pane 0 0 3 .5 .5 .5\n";
  EXPECT_TRUE(std::holds_alternative<ThinGlass>(materialOf(glass + "void mirror m 1 pane 0 3 1 1 1").surface));
  EXPECT_TRUE(std::holds_alternative<Mirror>(materialOf(glass + "void mirror m 1 void 0 3 1 1 1").surface));
  const Material illum = materialOf(glass + "void illum m 1 pane 0 3 1 1 1");
  EXPECT_FALSE(illum.emission.has_value());
  EXPECT_EQ(illum.name, "m");
  EXPECT_TRUE(materialOf("void illum m 0 0 3 1 1 1").emission.has_value());
}

TEST(RadMaterials, EmittersDoNotReflect) {
  for (const char* definition : {"void light m 0 0 3 3 2 1", "void glow m 0 0 4 3 2 1 0", "void illum m 0 0 3 3 2 1"}) {
    const Material material = materialOf(definition);
    ASSERT_TRUE(material.emission.has_value());
    expectNear(material.emission->radiance, {3, 2, 1});
    EXPECT_FALSE(material.emission->bothSides);
    expectNear(diffuseReflectance(material, true), Rgb(0.0f));
  }
}

TEST(RadMaterials, SpotlightHasItsFullAngleAndDirection) {
  const Material spot = materialOf("void spotlight m 0 0 7 60 60 60 30 0 0 -.2");
  ASSERT_TRUE(spot.emission && spot.emission->spot);
  EXPECT_NEAR(spot.emission->spot->fullAngle, kPi / 6, 1e-12);
  EXPECT_EQ(spot.emission->spot->direction, Vec3(0, 0, -0.2));
}

TEST(RadMaterials, WhatIsSimplifiedIsCounted) {
  const ImportReport report = read(
                                  "void glass g 0 0 3 1.09 1 1\nvoid dielectric d 0 0 5 1 1 1 1.5 9\n"
                                  "void metal2 m 4 x y z . 0 6 .5 .5 .5 1 .1 .2")
                                  .report;
  EXPECT_EQ(report.ignored.size(), 3u);
  EXPECT_EQ(report.warnings.size(), 1u);
}

TEST(RadSources, SmallLightsAreSunsAndGlowsAreDomes) {
  const Scene scene = read(
                          "void light solar 0 0 3 9 8 7  solar source sun 0 0 4 0 0 2 .5\n"
                          "void brightfunc skyfunc 2 skybr skybright.cal 0 7 1 4.319 7.491 .3227 .6 0 .8\n"
                          "skyfunc glow skyglow 0 0 4 .8 .9 1 0  skyglow source sky 0 0 4 0 0 1 180\n"
                          "void glow plain 0 0 4 1 2 3 0  plain source ground 0 0 4 0 0 -1 180\n")
                          .scene;
  ASSERT_EQ(scene.lights.size(), 3u);
  const auto& sun = std::get<SunLight>(scene.lights[0].emitter);
  EXPECT_EQ(scene.lights[0].name, "sun");
  EXPECT_NEAR(sun.angularRadius, glm::radians(0.25), 1e-12);
  expectNear(sun.radiance, {9, 8, 7});
  EXPECT_EQ(sun.direction, Vec3(0, 0, 1));
  const auto& sky = std::get<DomeLight>(scene.lights[1].emitter);
  const auto& distribution = std::get<RadianceSky>(sky.distribution);
  EXPECT_EQ(distribution.kind, RadianceSky::Kind::Clear);
  EXPECT_EQ(distribution.zenith, 4.319);
  EXPECT_EQ(distribution.ground, 7.491);
  EXPECT_EQ(distribution.normalization, 0.3227);
  EXPECT_NEAR(glm::distance(distribution.sunDirection, Vec3(0.6, 0, 0.8)), 0, 1e-12);
  expectNear(sky.scale, {0.8f, 0.9f, 1.0f});
  EXPECT_NEAR(sky.halfAngle, kPi / 2, 1e-12);
  const auto& ground = std::get<DomeLight>(scene.lights[2].emitter);
  EXPECT_TRUE(std::holds_alternative<UniformSky>(ground.distribution));
  expectNear(skyRadiance(ground, Vec3(0, 0, -1)), {1, 2, 3});
  EXPECT_NO_THROW(validate(scene));
}

TEST(RadSources, SkyArgumentsAreChecked) {
  EXPECT_NE(errorOf("void brightfunc s 2 skybr skybright.cal 0 3 1 2 3"), "");
  EXPECT_NE(errorOf("void brightfunc s 2 skybr skybright.cal 0 7 1 2 3 1 0 0 0"), "");
  EXPECT_NE(errorOf("void brightfunc s 3 skybr skybright.cal -q 0 3 2 2 3"), "");
  EXPECT_EQ(errorOf("void brightfunc s 2 skybr skybright.cal 0 3 2 2 3"), "");
}

}  // namespace
}  // namespace deltalux::io::radiance::test
