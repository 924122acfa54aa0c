// UGR and DGP of scenes whose luminances, solid angles and illuminances have closed forms: lamps in an even field.
#include <deltalux/glare.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/engine.hpp>
#include <nlohmann/json.hpp>

#include "scene/form_factor.hpp"
#include "support/rooms.hpp"
#include "support/solved.hpp"

namespace deltalux {
namespace {

const Eye kEye{{0, 0, 1.2}, {0, 1, 0}, {0, 0, 1}};

Rgb radianceOf(double luminance) { return Rgb(static_cast<float>(luminance / kLuminousEfficacy)); }

/// All around is of one luminance [cd/m2].
Scene evenField(double luminance) {
  Scene scene;
  DomeLight sky;
  sky.halfAngle = kPi, sky.scale = radianceOf(luminance), sky.distribution = UniformSky{1};
  scene.lights.push_back({"sky", sky, Rgb(1.0f)});
  const MaterialId black = test::addMaterial(scene, "black", test::lambert(0));
  test::addPolygon(scene, black, {{-1, -9, -9}, {1, -9, -9}, {1, -8, -9}, {-1, -8, -9}});  // behind the eye
  return scene;
}

/// A square lamp that shines down. Its corners, seen from below in a circle.
struct Square {
  Vec3 centre;
  double side = 0.6;

  std::vector<Vec3> corners() const {
    const double h = side / 2;
    return {centre + Vec3(-h, -h, 0), centre + Vec3(-h, h, 0), centre + Vec3(h, h, 0), centre + Vec3(h, -h, 0)};
  }
  /// By the closed form of a rectangle, corner by corner. [sr]
  double solidAngle(const Vec3& from) const {
    const double z = std::abs(centre.z - from.z);
    const auto part = [&](double x, double y) { return std::atan(x * y / (z * std::sqrt(x * x + y * y + z * z))); };
    const double x0 = centre.x - from.x - side / 2, x1 = x0 + side, y0 = centre.y - from.y - side / 2, y1 = y0 + side;
    return part(x1, y1) - part(x0, y1) - part(x1, y0) + part(x0, y0);
  }
  /// Of the illuminance that all of the surroundings bring to the eye, the share that it covers.
  double covers(const Eye& eye) const {
    const auto c = corners();
    double F = 0;
    for (const auto& t : {std::array{c[0], c[1], c[2]}, std::array{c[0], c[2], c[3]}})
      F += scene::formFactorToPolygon(Vec3f(eye.position), Vec3f(eye.direction),
                                      std::array<Vec3f, 3>{Vec3f(t[0]), Vec3f(t[1]), Vec3f(t[2])});
    return F;
  }
};

void addLamp(Scene& scene, const Square& lamp, double luminance, const std::string& name) {
  const MaterialId material =
      test::addMaterial(scene, name, test::lambert(0), Emission{radianceOf(luminance), false, {}});
  const PrimitiveId p = test::addPolygon(scene, material, lamp.corners());
  scene.primitives[p.index()].object = internObject(scene, name, '.');
}

UnifiedGlare ugr(Scene scene, const Eye& eye = kEye) {
  addAreaLights(scene);
  const Engine engine = test::solved(std::move(scene), 0.1);
  return unifiedGlare(engine.solution(), std::span(&eye, 1))[0];
}

/// P of a source straight above the line of sight, by sigma in degrees.
double above(double sigma) { return std::exp(33.98e-3 * sigma + 21e-5 * sigma * sigma); }

TEST(UnifiedGlare, OfASquareLampIsTheClosedForm) {
  const Square lamp{{0, 2.6, 2.7}};
  Scene scene = evenField(40);
  addLamp(scene, lamp, 4000, "lamp");
  const UnifiedGlare found = ugr(scene);
  const double omega = lamp.solidAngle(kEye.position), P = above(std::atan2(1.5, 2.6) * 180 / kPi),
               Lb = 40 * (1 - lamp.covers(kEye));
  ASSERT_EQ(found.luminaires.size(), 1u);
  EXPECT_EQ(found.luminaires[0].name, "lamp");
  EXPECT_NEAR(found.luminaires[0].source.luminance, 4000, 4);
  EXPECT_NEAR(found.luminaires[0].source.solidAngle, omega, 0.005 * omega);
  EXPECT_NEAR(found.luminaires[0].source.positionIndex, P, 0.003 * P);
  EXPECT_NEAR(found.luminaires[0].illuminance, 4000 * kPi * lamp.covers(kEye), 0.01 * 4000 * kPi * lamp.covers(kEye));
  EXPECT_NEAR(found.background, Lb, 0.01 * Lb);
  const double exact = 8 * std::log10(0.25 / Lb * 16e6 * omega / (P * P));
  EXPECT_NEAR(found.rating, exact, 0.01 * exact);
  RecordProperty("ugr", std::to_string(found.rating) + " closed form " + std::to_string(exact));
}

TEST(UnifiedGlare, OfTwoLampsIsTheSum) {
  const Square near{{0, 2.6, 2.7}}, far{{-1.5, 5, 2.9}, 0.9};
  Scene scene = evenField(25);
  addLamp(scene, near, 3000, "near"), addLamp(scene, far, 6000, "far");
  const UnifiedGlare found = ugr(scene);
  ASSERT_EQ(found.luminaires.size(), 2u);
  const double tau = std::atan2(1.5, 1.7) * 180 / kPi,
               sigma = std::acos(5 / std::sqrt(5 * 5 + 1.5 * 1.5 + 1.7 * 1.7)) * 180 / kPi;
  const double farP = std::exp((35.2 - 0.31889 * tau - 1.22 * std::exp(-2 * tau / 9)) * 1e-3 * sigma +
                               (21 + 0.26667 * tau - 0.002963 * tau * tau) * 1e-5 * sigma * sigma);
  const double nearP = above(std::atan2(1.5, 2.6) * 180 / kPi), Lb = 25 * (1 - near.covers(kEye) - far.covers(kEye));
  const double sum =
      9e6 * near.solidAngle(kEye.position) / (nearP * nearP) + 36e6 * far.solidAngle(kEye.position) / (farP * farP);
  const double exact = 8 * std::log10(0.25 / Lb * sum);
  EXPECT_NEAR(found.rating, exact, 0.01 * exact);
  EXPECT_EQ(found.luminaires[0].name, "far");
}

TEST(UnifiedGlare, DoesNotSeeWhatIsHiddenNorBehind) {
  const Square lamp{{0, 2.6, 2.7}}, behind{{0, -3, 2.7}};
  Scene scene = evenField(40);
  addLamp(scene, lamp, 4000, "lamp"), addLamp(scene, behind, 4000, "behind");
  const MaterialId black = test::addMaterial(scene, "screen", test::lambert(0));
  // Covers all that is left of the line of sight.
  test::addPolygon(scene, black, {{-2, 1, 0}, {0, 1, 0}, {0, 1, 4}, {-2, 1, 4}});
  const UnifiedGlare found = ugr(scene);
  ASSERT_EQ(found.luminaires.size(), 1u);
  const double half = lamp.solidAngle(kEye.position) / 2;
  EXPECT_NEAR(found.luminaires[0].source.solidAngle, half, 0.01 * half);
  EXPECT_NEAR(found.luminaires[0].source.luminance, 4000, 4);
}

/// 1000 cd downwards, I = 1000 cos gamma.
std::shared_ptr<Photometry> lambertian(const Vec3& opening) {
  auto p = std::make_shared<Photometry>();
  for (int v = 0; v <= 180; ++v) p->verticals.push_back(v);
  p->horizontals = {0, 360};
  for (int h = 0; h < 2; ++h)
    for (int v = 0; v <= 180; ++v) p->candela.push_back(v < 90 ? 1000 * std::cos(v * kPi / 180) : 0);
  p->opening = opening;
  return p;
}

TEST(UnifiedGlare, OfAMeasuredLightTakesItsLuminousArea) {
  const Vec3 at(0, 2.6, 2.7);
  const double d2 = 2.6 * 2.6 + 1.5 * 1.5, cosine = 1.5 / std::sqrt(d2);
  const struct {
    Vec3 opening;
    double area;  // across the line to the eye
  } cases[] = {{{0.3, 1.2, 0}, 0.36 * cosine},
               {{-0.5, -0.5, 0}, kPi / 4 * 0.25 * cosine},
               {{-0.5, 0, 0.1}, kPi / 4 * 0.25 * cosine + 0.05 * 2.6 / std::sqrt(d2)},
               {{0.3, 1.2, 0.1}, 0.36 * cosine + 0.12 * 2.6 / std::sqrt(d2)},
               {{0, 0, 0}, 0.005}};
  for (const auto& c : cases) {
    Scene scene = evenField(40);
    PhotometricLight light;
    light.position = at, light.photometry = lambertian(c.opening);
    // The 0 plane along y, towards the eye and away.
    light.frame = glm::dmat3(Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1));
    scene.lights.push_back({"measured", light, Rgb(1.0f)});
    const UnifiedGlare found = ugr(scene);
    ASSERT_EQ(found.luminaires.size(), 1u);
    const double L = 1000 * cosine / c.area, omega = c.area / d2;
    const LuminaireSeen& l = found.luminaires[0];
    const double area = c.opening.z > 0 && c.opening.x > 0 ? 0.36 * cosine + 0.03 * 2.6 / std::sqrt(d2) : c.area;
    EXPECT_NEAR(l.source.luminance, L * c.area / area, 0.001 * L) << c.opening.x;
    EXPECT_NEAR(l.source.solidAngle, omega * area / c.area, 0.001 * omega) << c.opening.x;
    EXPECT_EQ(l.small, c.area == 0.005);
    const double P = above(std::atan2(1.5, 2.6) * 180 / kPi), I = 1000 * cosine;
    const double exact = 8 * std::log10(0.25 / 40 * I * I / (area * d2 * P * P));
    EXPECT_NEAR(found.rating, exact, 0.01 * exact);
  }
}

TEST(UnifiedGlare, PartsOfOneLampThatTouchAreOne) {
  Scene scene = evenField(40);
  addLamp(scene, {{0, 2.6, 2.7}}, 4000, "lamp.a"), addLamp(scene, {{0.6, 2.6, 2.7}}, 4000, "lamp.b");
  addLamp(scene, {{2, 2.6, 2.7}}, 4000, "lamp.c"), addLamp(scene, {{2.6, 2.6, 2.7}}, 4000, "other");
  const UnifiedGlare found = ugr(scene);
  ASSERT_EQ(found.luminaires.size(), 3u);
  EXPECT_EQ(found.luminaires[0].lights.size(), 2u);
}

TEST(UnifiedGlare, IsTheSameForAnyUnit) {
  const auto rating = [](double unit) {
    Scene scene = evenField(40);
    const Square lamp{{0, 2.6 / unit, 2.7 / unit}, 0.6 / unit};
    addLamp(scene, lamp, 4000, "lamp");
    PointLight bulb;
    bulb.position = Vec3(0.5, 2, 2) / unit, bulb.intensity = Rgb(float(5 / (unit * unit)));
    scene.lights.push_back({"bulb", bulb, Rgb(1.0f)});
    scene.metresPerUnit = unit;
    return ugr(scene, {kEye.position / unit, kEye.direction, kEye.up});
  };
  const UnifiedGlare metres = rating(1), feet = rating(0.3048);
  ASSERT_EQ(metres.luminaires.size(), 2u);
  EXPECT_NEAR(metres.rating, feet.rating, 0.1);
  EXPECT_TRUE(metres.luminaires[0].small);
}

TEST(UnifiedGlare, WithoutLuminairesThereIsNone) { EXPECT_EQ(ugr(evenField(40)).rating, -kInfinity); }

TEST(DaylightGlare, OfAnEvenFieldFollowsFromItsIlluminance) {
  const Engine engine = test::solved(evenField(1500), 0.1);
  GlareSettings settings;
  settings.size = 128, settings.samplesPerPixel = 4;
  const DaylightGlare found = daylightGlare(engine.solution(), kEye, settings);
  EXPECT_TRUE(found.sources.empty());
  EXPECT_NEAR(found.illuminance, 1500 * kPi, 0.01 * 1500 * kPi);
  const double exact = 5.87e-5 * 1500 * kPi + 0.16;
  EXPECT_NEAR(found.probability, exact, 0.01 * exact);
}

TEST(DaylightGlare, OfOneSourceIsTheClosedForm) {
  const Square lamp{{0.4, 2.6, 2.7}, 1};
  Scene scene = evenField(800);
  addLamp(scene, lamp, 20000, "lamp");
  addAreaLights(scene);
  const Engine engine = test::solved(std::move(scene), 0.1);
  GlareSettings settings;
  settings.samplesPerPixel = 8;
  const DaylightGlare found = daylightGlare(engine.solution(), kEye, settings);
  const double omega = lamp.solidAngle(kEye.position), P = positionIndex(kEye, lamp.centre - kEye.position),
               E = kPi * (800 + (20000 - 800) * lamp.covers(kEye));
  ASSERT_EQ(found.sources.size(), 1u);
  EXPECT_NEAR(found.sources[0].solidAngle, omega, 0.05 * omega);  // a pixel's rim has some of the light
  EXPECT_NEAR(found.sources[0].luminance * found.sources[0].solidAngle, 20000 * omega, 0.01 * 20000 * omega);
  EXPECT_NEAR(found.illuminance, E, 0.01 * E);
  const double exact = 5.87e-5 * E + 9.18e-2 * std::log10(1 + 4e8 * omega / (std::pow(E, 1.87) * P * P)) + 0.16;
  EXPECT_NEAR(found.probability, exact, 0.01 * exact);
  RecordProperty("dgp", std::to_string(found.probability) + " closed form " + std::to_string(exact));

  // With a task of the field's luminance, five times that is the threshold.
  settings.task = kEye.position + Vec3(0, 1, -0.5);
  settings.size = 128;
  EXPECT_NEAR(daylightGlare(engine.solution(), kEye, settings).threshold, 4000, 40);

  const UnifiedGlare unified = unifiedGlare(engine.solution(), std::span(&kEye, 1))[0];
  const DisplayImage marked = markGlare(found, &unified);
  EXPECT_EQ(marked.width, settings.size * 4);
  EXPECT_EQ(marked.at(0, 0), (std::array<std::uint8_t, 3>{24, 24, 24}));
  const auto json = nlohmann::json::parse(toJson(engine.solution().scene(), &found, std::span(&unified, 1)));
  EXPECT_NEAR(json["dgp"]["dgp"].get<double>(), exact, 0.01 * exact);
  EXPECT_EQ(json["ugr"][0]["luminaires"][0]["name"], "lamp");
}

TEST(DaylightGlare, TheSunIsASourceOfItsOwnSize) {
  Scene scene = evenField(1000);
  SunLight sun;
  sun.direction = glm::normalize(Vec3(0.2, 1, 0.5)), sun.radiance = radianceOf(1e8);
  scene.lights.push_back({"sun", sun, Rgb(1.0f)});
  const MaterialId black = test::addMaterial(scene, "screen", test::lambert(0));
  const Engine engine = test::solved(scene, 0.1);
  GlareSettings settings;
  settings.size = 128, settings.samplesPerPixel = 4;
  const DaylightGlare found = daylightGlare(engine.solution(), kEye, settings);
  ASSERT_EQ(found.sources.size(), 1u);
  EXPECT_NEAR(found.sources[0].luminance, 1e8, 1e5);
  EXPECT_NEAR(found.sources[0].solidAngle, solidAngle(sun), 0.001 * solidAngle(sun));
  const double E = kPi * 1000 + 1e8 * solidAngle(sun) * sun.direction.y;
  EXPECT_NEAR(found.illuminance, E, 0.01 * E);

  test::addPolygon(scene, black, {{-2, 3, 0}, {2, 3, 0}, {2, 3, 5}, {-2, 3, 5}});
  const Engine hidden = test::solved(scene, 0.1);
  EXPECT_TRUE(daylightGlare(hidden.solution(), kEye, settings).sources.empty());
}

}  // namespace
}  // namespace deltalux
