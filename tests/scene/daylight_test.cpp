// Sun and sky of times and places, against published positions and by what they come to on the ground.
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/daylight.hpp>
#include <deltalux/edit.hpp>
#include <deltalux/error.hpp>

#include "scene/daylight/perez.hpp"
#include "scene/daylight/sun.hpp"

namespace deltalux {
namespace {

constexpr double kWithin = 0.02;  // degrees, of published positions

CivilTime at(const char* text) { return parseCivilTime(text).value(); }

scene::SolarCoordinates coordinates(const char* universal) {
  const CivilTime t = at(universal);
  return scene::solarCoordinates(scene::daysSince2000(t.year, t.month, t.day, t.hour), t.hour);
}

TEST(Daylight, TheSunStandsWherePublishedExamplesHaveIt) {
  // I. Reda, A. Andreas, Solar Position Algorithm for Solar Radiation Applications, NREL 2008, A.5.
  const SunSighting golden = sightSun(at("2003-10-17T12:30:30-07:00"), {39.742476, -105.1786});
  EXPECT_NEAR(glm::degrees(golden.altitude), 90 - 50.11162, kWithin);
  EXPECT_NEAR(glm::degrees(golden.azimuth), 194.34024, kWithin);
  // J. Meeus, Astronomical Algorithms, 2nd edition, example 25.a.
  const scene::SolarCoordinates meeus = coordinates("1992-10-13T00:00Z");
  EXPECT_NEAR(glm::degrees(meeus.declination), -7.78507, kWithin);
  EXPECT_NEAR(glm::degrees(meeus.rightAscension) + 360, 198.38083, kWithin);
}

TEST(Daylight, SeasonsBeginWhenAlmanacsSay) {
  EXPECT_NEAR(glm::degrees(coordinates("2026-03-20T14:46Z").declination), 0, kWithin);
  EXPECT_NEAR(glm::degrees(coordinates("2026-06-21T08:25Z").declination), 23.438, kWithin);
  EXPECT_NEAR(glm::degrees(coordinates("2026-09-23T00:05Z").declination), 0, kWithin);
  EXPECT_NEAR(glm::degrees(coordinates("2026-12-21T20:50Z").declination), -23.438, kWithin);
}

TEST(Daylight, TheSunTurnsWithTheDay) {
  const Place zurich{47.37, 8.54};
  const auto azimuth = [&](const char* time) { return glm::degrees(sightSun(at(time), zurich).azimuth); };
  EXPECT_NEAR(azimuth("2026-06-21T07:00+02:00"), 75, 10);
  EXPECT_NEAR(azimuth("2026-06-21T13:28+02:00"), 180, 2);
  EXPECT_NEAR(azimuth("2026-06-21T20:00+02:00"), 285, 10);
  EXPECT_LT(sightSun(at("2026-06-21T00:00+02:00"), zurich).altitude, 0);
  EXPECT_NEAR(glm::degrees(sightSun(at("2026-03-20T14:46Z"), {90, 0}).altitude), glm::degrees(scene::refraction(0)),
              kWithin);
  // Without a zone, the whole hour that suits the longitude.
  EXPECT_EQ(sightSun(at("2026-06-21T12:00"), zurich).azimuth, sightSun(at("2026-06-21T11:00Z"), zurich).azimuth);
}

Daylighting noon(const char* sky) {
  Daylighting daylight;
  daylight.sky = parseSkyModel(sky).value();
  daylight.time = at("2026-06-21T13:28+02:00"), daylight.place = {47.37, 8.54};
  return daylight;
}

/// Of sky and sun, on the horizontal [lux].
std::pair<double, double> onTheGround(const Daylighting& daylight) {
  const SunAndSky lights = sunAndSky(daylight, {0, 0, 1}, kLuminousEfficacy);
  return {kLuminousEfficacy * scene::horizontalIrradiance(lights.sky),
          kLuminousEfficacy * lights.sun.radiance.g * solidAngle(lights.sun) * lights.sun.direction.z};
}

TEST(Daylight, IrradiancesBecomeLightByTheirEfficacies) {
  const Daylighting daylight = noon("perez:800,100");
  const auto [sky, sun] = onTheGround(daylight);
  const double zenith = kPi / 2 - sightSun(daylight.time, daylight.place).altitude;
  const double outside = scene::outsideIrradiance(172);
  EXPECT_NEAR(outside, 1367 * 0.9674, 1.5);  // far from the sun in June
  const scene::SkyCondition condition = scene::conditionOf({800, 100}, zenith, outside);
  const scene::Daylight K = scene::efficacies(condition, 2);
  EXPECT_NEAR(sky, 100 * K.diffuse, 1e-3 * sky);
  EXPECT_NEAR(sun, 800 * K.directNormal * std::cos(zenith), 1e-3 * sun);
  EXPECT_NEAR(K.diffuse, 135, 15);
  EXPECT_NEAR(K.directNormal, 105, 10);
  // Luminances by the published coefficients of the bin, clearness above 6.2, relative to the zenith's. [PSM93]
  EXPECT_GT(condition.clearness, 6.2);
  const double Z = zenith, D = condition.brightness;
  const double a = -1.05 + 0.0289 * Z + D * (0.426 + 0.359 * Z), b = -0.325 + 0.1156 * Z + D * (0.7781 + 0.0025 * Z);
  const double c = 31.0625 - 14.5 * Z + D * (-46.1148 + 55.375 * Z);
  const double d = -7.2312 + 0.405 * Z + D * (13.35 + 0.6234 * Z), e = 1.5 - 0.6426 * Z + D * (1.8564 + 0.5636 * Z);
  const SunAndSky lights = sunAndSky(daylight, {0, 0, 1}, kLuminousEfficacy);
  const auto relative = [&](const Vec3& w) {
    const double gamma = std::acos(glm::dot(w, lights.sun.direction));
    return (1 + a * std::exp(b / w.z)) * (1 + c * std::exp(d * gamma) + e * std::cos(gamma) * std::cos(gamma));
  };
  const Vec3 up(0, 0, 1);
  for (const Vec3& w : {Vec3(0.6, 0, 0.8), Vec3(0, -0.6, 0.8), Vec3(0, 0.8, 0.6), Vec3(-0.96, 0, 0.28)})
    EXPECT_NEAR(skyRadiance(lights.sky, w).g / skyRadiance(lights.sky, up).g, relative(w) / relative(up), 1e-4);
}

TEST(Daylight, GeneralSkiesAreAsBrightAsIsTypical) {
  // Overcast: a tenth of what is beyond the atmosphere, no sun, the zenith three times the horizon.
  const auto [gray, none] = onTheGround(noon("cie:1"));
  const double sine = std::sin(sightSun(at("2026-06-21T13:28+02:00"), {47.37, 8.54}).altitude);
  EXPECT_NEAR(gray, 0.10 * 133.8e3 * 0.9674 * sine, 10);
  EXPECT_EQ(none, 0);
  const auto [blue, sun] = onTheGround(noon("cie:12"));
  EXPECT_NEAR(blue, 0.10 * 133.8e3 * 0.9674 * sine, 100);
  EXPECT_GT(sun, 65e3);
  EXPECT_LT(sun, 100e3);
  for (int type = 1; type <= 15; ++type) {
    const auto [sky, beam] = onTheGround(noon(("cie:" + std::to_string(type) + ",10000").c_str()));
    EXPECT_NEAR(sky, 10000, 10) << type;
    EXPECT_EQ(beam, 0) << type;
  }
}

TEST(Daylight, TheGroundReflectsWhatFallsOnIt) {
  Daylighting daylight = noon("perez:800,100");
  daylight.groundReflectance = 0.3;
  const auto [sky, sun] = onTheGround(daylight);
  const SunAndSky lights = sunAndSky(daylight, {0, 0, 1}, kLuminousEfficacy);
  EXPECT_NEAR(kLuminousEfficacy * skyRadiance(lights.sky, {0.6, 0, -0.8}).g * kPi, 0.3 * (sky + sun), 0.005 * sun);
}

TEST(Daylight, DuskAndNightAreNoTrouble) {
  for (const char* sky : {"perez:500,50", "perez:0,20", "perez:0,0", "cie:1", "cie:12", "cie:7,5000"})
    for (const char* time : {"2026-06-21T00:30", "2026-06-21T04:25", "2026-06-21T04:40", "2026-12-21T16:30"}) {
      Daylighting daylight = noon(sky);
      daylight.time = at(time);
      const SunAndSky lights = sunAndSky(daylight, {0, 0, 1}, kLuminousEfficacy);
      Scene scene;
      setDaylight(scene, daylight);
      EXPECT_NO_THROW(validate(scene)) << sky << time;
      const auto [diffuse, beam] = onTheGround(daylight);
      EXPECT_TRUE(std::isfinite(diffuse) && std::isfinite(beam)) << sky << time;
      if (sightSun(daylight.time, daylight.place).altitude < 0) {
        EXPECT_EQ(lights.sun.radiance, Rgb(0.0f)) << sky << time;
      }
    }
}

TEST(Daylight, NorthIsTheScenes) {
  Daylighting daylight = noon("perez:800,100");
  const auto sunOf = [&](const Vec3& up) { return sunAndSky(daylight, up, kLuminousEfficacy).sun.direction; };
  EXPECT_LT(sunOf({0, 0, 1}).y, -0.3);  // at noon, in the south
  EXPECT_GT(sunOf({0, 1, 0}).z, 0.3);
  EXPECT_NEAR(sunOf({0, 1, 0}).y, sunOf({0, 0, 1}).z, 1e-12);
  daylight.north = 90;  // north is where the scene has east
  EXPECT_LT(sunOf({0, 0, 1}).x, -0.3);
  daylight.time = at("2026-06-21T07:00+02:00"), daylight.north = 0;
  EXPECT_GT(sunOf({0, 0, 1}).x, 0.5);
  EXPECT_GT(sunOf({0, 1, 0}).x, 0.5);
}

TEST(Daylight, TakesThePlaceOfOtherSkies) {
  Scene scene;
  scene.lights = {
      {"solar", SunLight{}, Rgb(1.0f)}, {"lamp", PointLight{}, Rgb(1.0f)}, {"skyglow", DomeLight{}, Rgb(1.0f)}};
  scene.backdrops.resize(1);
  EXPECT_EQ(setDaylight(scene, noon("cie:12")), 3u);
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].name, "lamp");
  EXPECT_EQ(scene.lights[1].name, "sun");
  EXPECT_EQ(scene.lights[2].name, "sky");
  EXPECT_TRUE(scene.backdrops.empty());
}

TEST(Daylight, AnEditKeepsLightsAndIsUndone) {
  Scene scene;
  scene.lights = {
      {"solar", SunLight{}, Rgb(0.5f)}, {"glow", DomeLight{}, Rgb(1.0f)}, {"ground", DomeLight{}, Rgb(1.0f)}};
  const std::vector<Light> before = scene.lights;
  EditHistory history;
  const AppliedEdit applied = history.apply(scene, SetDaylight{noon("perez:800,100")});
  EXPECT_EQ(applied.change.lights.size(), 3u);
  const SunAndSky lights = sunAndSky(noon("perez:800,100"), scene.up, scene.luminousEfficacy);
  EXPECT_EQ(std::get<SunLight>(scene.lights[0].emitter), lights.sun);
  EXPECT_EQ(scene.lights[0].scale, Rgb(0.5f));
  EXPECT_EQ(std::get<DomeLight>(scene.lights[1].emitter), lights.sky);
  EXPECT_EQ(std::get<DomeLight>(scene.lights[2].emitter).scale, Rgb(0.0f));
  history.undo(scene);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(scene.lights[i].emitter == before[i].emitter) << i;
  Scene dark;
  history.apply(dark, SetDaylight{noon("cie:12")});
  ASSERT_EQ(dark.lights.size(), 2u);
  EXPECT_EQ(dark.lights[0].name, "sun");
  EXPECT_GT(std::get<SunLight>(dark.lights[0].emitter).radiance.g, 0);
  Daylighting none = noon("cie:12");
  std::get<GeneralSky>(none.sky).type = 16;
  EXPECT_THROW(validateEdit(dark, SetDaylight{none}), InputError);
}

TEST(Daylight, TextsAreReadAndWritten) {
  for (const char* text : {"cie:1", "cie:15,10000", "perez:812.5,96", "perez:0,0"}) {
    ASSERT_TRUE(parseSkyModel(text)) << text;
    EXPECT_EQ(toText(*parseSkyModel(text)), text);
  }
  for (const char* text : {"", "cie:0", "cie:16", "cie:1.5", "cie:1,", "cie:1,-5", "perez:1", "perez:1,nan",
                           "perez:-1,5", "perez:1,2,3", "sky", "cie:1 "})
    EXPECT_FALSE(parseSkyModel(text)) << text;
  for (const char* text :
       {"2026-06-21T09:00", "2024-02-29T23:59:59", "2026-06-21T09:00+02:00", "1999-12-31T00:00-05:30"}) {
    ASSERT_TRUE(parseCivilTime(text)) << text;
    EXPECT_EQ(toText(*parseCivilTime(text)), text);
  }
  EXPECT_EQ(at("2026-06-21 09:00Z"), at("2026-06-21T09:00+00:00"));
  EXPECT_EQ(at("2026-06-21T09:00+0200"), at("2026-06-21T09:00+02"));
  for (const char* text : {"", "2026", "2026-06-21", "2026-06-21T", "2026-13-01T09:00", "2025-02-29T09:00",
                           "2026-06-21T24:00", "2026-06-21T09:60", "2026-06-21T09:00:60", "2026-06-21T09:00+15:00",
                           "2026-06-21T09:00+02:00x", "26-06-21T09:00", "1800-06-21T09:00"})
    EXPECT_FALSE(parseCivilTime(text)) << text;
  EXPECT_EQ(parsePlace("47.37,8.54"), (Place{47.37, 8.54}));
  EXPECT_EQ(parsePlace("-33.9, 151.2"), (Place{-33.9, 151.2}));
  for (const char* text : {"", "47", "91,0", "0,181", "47.37;8.54", "47,8,0"}) EXPECT_FALSE(parsePlace(text)) << text;
}

}  // namespace
}  // namespace deltalux
