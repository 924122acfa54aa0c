#include <gtest/gtest.h>

#include "io/radiance/calc.hpp"
#include "io/radiance/data_table.hpp"
#include "io/radiance/memory_files.hpp"
#include "scene/light_sampling.hpp"

namespace deltalux::io::radiance::test {
namespace {

using Files = std::map<std::string, std::string>;

/// Radiant intensity of all emitting surfaces into `w` [W/sr], by quadrature over each.
double intensity(const Scene& scene, const Vec3& w) {
  constexpr int kSteps = 40;
  double sum = 0;
  for (const Primitive& primitive : scene.primitives) {
    const auto& emission = scene[primitive.material].emission;
    if (!emission) continue;
    double mean = 0;
    for (int j = 0; j < kSteps; ++j)
      for (int i = 0; i < kSteps; ++i) {
        const SurfacePoint p = samplePoint(primitive.shape, {(i + 0.5) / kSteps, (j + 0.5) / kSteps});
        const double cosine = glm::dot(p.normal, w);
        if (cosine > 0) mean += cosine * gray(scene::emittedRadiance(*emission, w, 1e6, true)) / (kSteps * kSteps);
      }
    sum += mean * area(primitive.shape);
  }
  return sum;
}

/// What leaves them all by what their radiance says of the mean [W].
double flux(const Scene& scene) {
  double sum = 0;
  for (const Primitive& primitive : scene.primitives)
    if (const auto& emission = scene[primitive.material].emission)
      sum += kPi * gray(emission->radiance) * area(primitive.shape);
  return sum;
}

/// In ies2rad's frame: aimed at -z, azimuth from +x towards -y. Degrees.
Vec3 leaving(double theta, double phi) {
  const double t = glm::radians(theta), p = glm::radians(phi);
  return {std::sin(t) * std::cos(p), -std::sin(t) * std::sin(p), -std::cos(t)};
}

const char* const kDownlight =
    "void brightdata d 4 flatcorr d.dat source.cal src_theta 0 1 12.7324\n"
    "d light l 0 0 3 1 1 1\n"
    "l ring lamp 0 0 8 0 0 2  0 0 -1  0 .158114\n";
const char* const kDownlightData = "1\n0 180 5  # every 45 degrees\n5.5866 5.5866 0 0 0\n";

TEST(Patterns, FlatSourcesHaveTheIntensityOfTheirData) {
  const ImportedScene read = test::read(kDownlight, {{"d.dat", kDownlightData}});
  EXPECT_TRUE(read.report.warnings.empty());
  for (const auto& [theta, factor] : {std::pair(0.0, 1.0), {30.0, 1.0}, {44.0, 1.0}, {60.0, 2.0 / 3}, {85.0, 1.0 / 9}})
    EXPECT_NEAR(intensity(read.scene, leaving(theta, 77)), factor * 5.5866, 0.003 * 5.5866) << theta;
  // 2 pi integral of v sin, v constant to 45 degrees and then linear to 0 at 90
  const double half = std::sqrt(0.5), integral = 1 - half + half - (1 - half) / (kPi / 4);
  EXPECT_NEAR(flux(read.scene) / (2 * kPi * 5.5866 * integral), 1, 0.005);
}

TEST(Patterns, BoxesAndBallsHaveTheIntensityOfTheirData) {
  // Over phi at 0, 90, 180, 270 and 360 degrees, over theta at 0, 90 and 180.
  const Files files{{"d.dat", "2\n0 360 5\n0 180 3\n 4 1 2  4 3 2  4 5 2  4 2 2  4 1 2\n"}};
  const std::string light = " light l 0 0 3 1 1 1\n";
  const ImportedScene box =
      test::read("void brightdata d 5 boxcorr d.dat source.cal src_phi src_theta 0 4 1 .2 .3 .1\nd" + light +
                     "!genbox l b .2 .3 .1\n",
                 files);
  const ImportedScene ball = test::read("void brightdata d 5 corr d.dat source.cal src_phi src_theta 0 1 31.830989\nd" +
                                            light + "l sphere s 0 0 4 0 0 0 .1\n",
                                        files);
  for (const ImportedScene* read : {&box, &ball}) {
    EXPECT_TRUE(read->report.warnings.empty());
    EXPECT_NEAR(intensity(read->scene, leaving(0, 0)), 4, 0.02);
    EXPECT_NEAR(intensity(read->scene, leaving(90, 45)), 2, 0.02);
    EXPECT_NEAR(intensity(read->scene, leaving(90, 90)), 3, 0.02);
    EXPECT_NEAR(intensity(read->scene, leaving(90, 270)), 2, 0.02);
    EXPECT_NEAR(intensity(read->scene, leaving(45, 180)), 4.5, 0.03);
    EXPECT_NEAR(intensity(read->scene, leaving(135, 90)), 2.5, 0.02);
    // Mean over phi: 4 at the pole, 2.75 around, 2 above; linear between, against sin.
    EXPECT_NEAR(flux(read->scene) / (2 * kPi * (4 + 2) * (1 - 2 / kPi) + 2 * kPi * 2.75 * 4 / kPi), 1, 0.01);
  }
}

TEST(Patterns, SymmetriesFoldTheAzimuth) {
  const Files files{{"two.dat", "2\n0 180 3\n0 180 2\n 1 1 2 2 3 3\n"}, {"four.dat", "2\n0 90 2\n0 180 2\n 1 1 2 2\n"}};
  const auto read = [&](const std::string& data, const std::string& words) {
    return test::read("void brightdata d " + std::string(words.find("-rz") == std::string::npos ? "5" : "7") +
                          " corr " + data + " source.cal " + words +
                          " 0 1 31.830989 d light l 0 0 3 1 1 1 l sphere s 0 0 4 0 0 0 .1",
                      files)
        .scene;
  };
  const Scene two = read("two.dat", "src_phi2 src_theta"), four = read("four.dat", "src_phi4 src_theta");
  // Data from 90 to 270 degrees, as ies2rad has them: mirrored across the plane of 90 and 270.
  const Scene side = read("two.dat", "src_phi2 src_theta -rz -90");
  for (const auto& [phi, expected] : {std::pair(0.0, 1.0), {90.0, 2.0}, {180.0, 3.0}, {270.0, 2.0}, {300.0, 5.0 / 3}})
    EXPECT_NEAR(intensity(two, leaving(90, phi)), expected, 0.01) << phi;
  for (const auto& [phi, expected] : {std::pair(0.0, 1.0), {90.0, 2.0}, {180.0, 1.0}, {270.0, 2.0}, {135.0, 1.5}})
    EXPECT_NEAR(intensity(four, leaving(90, phi)), expected, 0.01) << phi;
  for (const auto& [phi, expected] : {std::pair(90.0, 1.0), {180.0, 2.0}, {270.0, 3.0}, {0.0, 2.0}})
    EXPECT_NEAR(intensity(side, leaving(90, phi)), expected, 0.01) << phi;
}

TEST(Patterns, TurnWithTheLampThatHasThem) {
  const Files files{{"lamp.rad", kDownlight}, {"d.dat", kDownlightData}};
  const Scene turned = test::read("!xform -rx 90 -s 2 -t 3 4 5 lamp.rad", files).scene;
  for (const double theta : {0.0, 50.0, 70.0}) {
    const Vec3 w = leaving(theta, 20), to(w.x, -w.z, w.y);
    EXPECT_NEAR(intensity(turned, to), 4 * intensity(test::read(kDownlight, files).scene, w), 1e-3) << theta;
  }
  // A transform of the pattern's own, without the surface's.
  const Scene own =
      test::read("void brightfunc f 4 noneg(Dz) . -rx 90 0 0 f light l 0 0 3 1 1 1 l sphere s 0 0 4 0 0 0 1").scene;
  EXPECT_NEAR(intensity(own, Vec3(0, 1, 0)), kPi, 0.02);
  EXPECT_NEAR(intensity(own, Vec3(0, -1, 0)), 0, 1e-3);
}

TEST(Patterns, WindowsShineAsTheSkyBehindThem) {
  const std::string sky = "void brightfunc sky 2 skybr skybright.cal 0 7 1 4.319 2 .3227 .6 0 .8\n",
                    use =
                        "sky light w 0 0 3 1 .8 .6  w polygon p 0 0 12 0 0 0  0 1 0  0 1 1  0 0 1\n"
                        "sky glow g 0 0 4 1 .8 .6 0  g source s 0 0 4 0 0 1 360\n";
  const Scene scene = test::read(sky + use).scene;
  const Emission& window = *scene.materialOf(PrimitiveId(0)).emission;
  for (const Vec3 w : {Vec3(1, 0, -0.2), Vec3(1, 0.7, -1), Vec3(0.2, 0.1, -0.5), Vec3(1, 0, 0.6)}) {
    const Vec3 to = glm::normalize(w);
    const Rgb expected = skyRadiance(std::get<DomeLight>(scene.lights[0].emitter), -to);
    EXPECT_LT(glm::length(scene::emittedRadiance(window, to, 1, true) - expected), 0.01f * glm::length(expected));
  }
}

TEST(Patterns, ConstantsScaleTheRadiance) {
  const Scene scene = test::read(
                          "void colorfunc a 4 1 A1 A1/2 . 0 1 .5\n"
                          "a brightfunc b 2 4 . 0 0\n"
                          "b light l 0 0 3 1 1 1  l sphere s 0 0 4 0 0 0 1\n")
                          .scene;
  const Emission& emission = *scene.materialOf(PrimitiveId(0)).emission;
  EXPECT_FALSE(emission.pattern);
  EXPECT_LT(glm::length(emission.radiance - Rgb(4, 2, 1)), 1e-5f);
}

TEST(Patterns, FunctionFilesStandBesideTheScene) {
  const Files files{{"beam.cal", "{ a beam { nested } }\nwidth : arg(1);\nup = Dz;\nbeam = if(up - width, A2, 0);\n"}};
  const Scene scene =
      test::read("void brightfunc b 2 beam beam.cal 0 2 .5 3  b light l 0 0 3 1 1 1  l sphere s 0 0 4 0 0 0 1", files)
          .scene;
  EXPECT_NEAR(intensity(scene, leaving(50, 0)), 3 * kPi, 0.01);
  EXPECT_NEAR(intensity(scene, leaving(70, 0)), 0, 1e-3);
  EXPECT_NEAR(flux(scene) / (kPi * 3 * kPi), 1, 0.01);  // a quarter of the sphere, of I = 3 pi
}

TEST(Patterns, SourcesAtInfinityAreTabulatedSkies) {
  const Scene scene =
      test::read("void brightfunc f 2 2+Dx . 0 0  f glow g 0 0 4 1 2 4 0  g source s 0 0 4 0 0 1 180").scene;
  const auto& dome = std::get<DomeLight>(scene.lights[0].emitter);
  ASSERT_TRUE(std::holds_alternative<TabulatedSky>(dome.distribution));
  const Vec3 towards = glm::normalize(Vec3(1, 2, 3));
  const Rgb expected = static_cast<float>(2 + towards.x) * Rgb(1, 2, 4);
  EXPECT_LT(glm::length(skyRadiance(dome, towards) - expected), 2e-3f * glm::length(expected));
  EXPECT_NO_THROW(validate(scene));
}

TEST(Patterns, GendaylitsSkyIsPerezs) {
  const Scene scene = test::read(
                          "void brightfunc skyfunc 2 skybright perezlum.cal 0 10 12 4 -.6 -.3 5 -2.5 .3 0 -.6 .8\n"
                          "skyfunc glow g 0 0 4 1 1 1 0  g source sky 0 0 4 0 0 1 360")
                          .scene;
  const auto& dome = std::get<DomeLight>(scene.lights[0].emitter);
  ASSERT_TRUE(std::holds_alternative<PerezSky>(dome.distribution));
  const double gamma = std::acos(0.8),
               expected = 12 * (1 - 0.6 * std::exp(-0.3)) * (1 + 5 * std::exp(-2.5 * gamma) + 0.3 * 0.64);
  EXPECT_NEAR(skyRadiance(dome, Vec3(0, 0, 1)).r, expected, 1e-4 * expected);
  EXPECT_NEAR(skyRadiance(dome, Vec3(0, 0, -1)).r, 4, 1e-5);
}

TEST(Patterns, WhatCannotBeReadIsCounted) {
  const std::string lamp = " light l 0 0 3 2 2 2  l sphere s 0 0 4 0 0 0 1";
  const std::pair<const char*, const char*> cases[] = {
      {"void brightdata p 4 corr none.dat source.cal src_theta 0 1 1", "none.dat"},
      {"void brightfunc p 2 x none.cal 0 0", "none.cal"},
      {"void brightfunc p 2 nothing . 0 0", "nothing"},
      {"void brightfunc p 2 a loop.cal 0 0", "itself"},
      {"void brightfunc p 2 1/(Dz-Dz) . 0 0", "not finite"},
      {"void brightfunc p 3 1 . -q 0 0", "transform"},
      {"void brightfunc p 1 1 0 0", "too few"},
      {"void brightdata p 4 corr bad.dat source.cal src_theta 0 1 1", "ends before"},
      {"void brightdata p 4 corr huge.dat source.cal src_theta 0 1 1", "ends before"},
  };
  const Files files{
      {"loop.cal", "a = b; b = a;"}, {"bad.dat", "1 0 180 3 1 2"}, {"huge.dat", "2 0 1 10000000 0 1 10000000 1"}};
  for (const auto& [pattern, reason] : cases) {
    const ImportedScene read = test::read(std::string(pattern) + " p" + lamp, files);
    ASSERT_EQ(read.report.warnings.size(), 1u) << pattern;
    EXPECT_NE(read.report.warnings[0].find(reason), std::string::npos) << read.report.warnings[0];
    EXPECT_EQ(read.scene.materialOf(PrimitiveId(0)).emission->radiance, Rgb(2.0f)) << pattern;
  }
}

TEST(Patterns, SurfacesThatDoNotEmitAreAsBright) {
  const ImportedScene read = test::read(
      "void brightfunc p 2 .5 . 0 0  p plastic m 0 0 5 .5 .5 .5 0 0  m sphere s 0 0 4 0 0 0 1\n"
      "void texfunc t 4 0 0 0 . 0 0  t light l 0 0 3 1 1 1  l sphere s 0 0 4 3 0 0 1");
  EXPECT_EQ(read.report.ignored, (std::map<std::string, std::size_t>{{"texfunc", 1}}));
  EXPECT_FLOAT_EQ(diffuseReflectance(read.scene.materialOf(PrimitiveId(0)), true).g, 0.25f);
}

TEST(Patterns, WorkIsBounded) {
  MemoryFiles none;
  ExpansionLimits limits;
  limits.patternCalls = 1000;
  const ImportedScene read =
      readRadiance(sourceFile("void brightfunc p 2 abs(Dz) . 0 0  p light l 0 0 3 1 1 1  l sphere s 0 0 4 0 0 0 1"),
                   none, {}, limits);
  ASSERT_EQ(read.report.warnings.size(), 1u);
  EXPECT_NE(read.report.warnings[0].find("too often"), std::string::npos) << read.report.warnings[0];
}

TEST(DataTable, InterpolatesAndGoesOnForOneStep) {
  const auto table = [](const std::string& text) { return parseDataTable({"t.dat", {}, "t.dat", text}); };
  const DataTable line = table("# a comment\n1\n0 0 4  0 1 3 6\n 10 20 40 10");
  const auto at = [&](double x) { return valueAt(line, std::array{x}); };
  EXPECT_DOUBLE_EQ(at(0.25), 12.5);
  EXPECT_DOUBLE_EQ(at(2), 30);
  EXPECT_DOUBLE_EQ(at(-0.5), 5);
  EXPECT_DOUBLE_EQ(at(-2), 0);
  const DataTable falling = table("1 1 0 3  5 7 9");
  EXPECT_DOUBLE_EQ(valueAt(falling, std::array{0.75}), 6);
  EXPECT_DOUBLE_EQ(valueAt(falling, std::array{-1.5}), 11.0 / 3);  // 11 one step on, a third three steps on
  const DataTable plane = table("2\n0 1 2\n0 2 3\n 0 1 2  10 11 12");
  EXPECT_DOUBLE_EQ(valueAt(plane, std::array{0.5, 1.5}), 6.5);
  EXPECT_TRUE(std::isnan(valueAt(plane, std::array{0.5, std::nan("")})));
  for (const char* bad : {"", "0", "6 0 1 2", "1 0 0 3 1 2 2 1 1 1", "1 0 0 3 1 2 1 1 1 1", "1 0 1 0", "1 0 1 -1",
                          "1 0 1 2 5", "1 0 1 2 5 nan", "1 0 1 9999999999 5", "x"})
    EXPECT_THROW(table(bad), InputError) << bad;
}

TEST(Calc, BoundVariablesChangeBetweenEvaluations) {
  Calc calc({});
  double& x = calc.bind("x");
  double& y = calc.bind("y");
  calc.define("a = 2 * x; b = a + k; k = 3; f(t) = t * b; dead = y;");
  const auto f = calc.function({}, "f(10) + sqrt(k + 1)");
  x = 1;
  EXPECT_DOUBLE_EQ(f({}), 52);
  x = 2, y = 5;
  EXPECT_DOUBLE_EQ(f({}), 72);
  EXPECT_TRUE(calc.reads("x"));
  EXPECT_FALSE(calc.reads("y"));
  EXPECT_THROW(calc.function({}, "c"), InputError);
}

}  // namespace
}  // namespace deltalux::io::radiance::test
