#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "io/radiance/sun_position.hpp"

namespace deltalux::io::radiance::test {
namespace {

SunAngles sunAt(int month, int day, double hour, double latitude, double longitude, double meridian) {
  SunTime time;
  time.month = month, time.day = day, time.hour = hour;
  return sunAngles(time, {glm::radians(latitude), glm::radians(longitude), glm::radians(meridian)});
}

RadianceSky skyOfCommand(const std::string& options) {
  for (const RadObject& object : expand("!gensky " + options)) {
    if (object.type == Type::SkyBrightness) return std::get<RadianceSky>(skyOf(object));
  }
  throw std::runtime_error("no sky");
}

/// Integral of L cos over the upper hemisphere.
double horizontalIrradiance(const RadianceSky& sky) {
  DomeLight dome;
  dome.distribution = sky;
  constexpr int kSteps = 300;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double cosine = std::sqrt((i + 0.5) / kSteps), sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < kSteps; ++j) {
      const double azimuth = 2 * kPi * (j + 0.5) / kSteps;
      sum += skyRadiance(dome, {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine}).r;
    }
  }
  return kPi * sum / (kSteps * kSteps);
}

TEST(SunAngles, SolsticesAndEquinoxesAtSolarNoon) {
  SunTime noon;
  noon.solar = true, noon.hour = 12;
  const Site site{glm::radians(40.0), 0, 0};
  noon.month = 6, noon.day = 21;
  EXPECT_NEAR(glm::degrees(sunAngles(noon, site).altitude), 90 - 40 + 23.44, 0.1);
  noon.month = 12;
  EXPECT_NEAR(glm::degrees(sunAngles(noon, site).altitude), 90 - 40 - 23.44, 0.2);
  noon.month = 3;
  EXPECT_NEAR(glm::degrees(sunAngles(noon, site).altitude), 50, 0.7);
  EXPECT_NEAR(sunAngles(noon, site).azimuth, 0, 1e-9);
}

TEST(SunAngles, MorningIsEastAndEveningWest) {
  const Vec3 morning = sunDirection(sunAt(6, 21, 8, 40, 0, 0)), evening = sunDirection(sunAt(6, 21, 16, 40, 0, 0));
  EXPECT_GT(morning.x, 0.5);
  EXPECT_LT(evening.x, -0.5);
  EXPECT_NEAR(glm::length(morning), 1, 1e-12);
}

TEST(SunAngles, HandbookAndAlmanacAgree) {
  for (int month = 1; month <= 12; ++month) {
    for (const double hour : {8.0, 12.0, 15.5}) {
      SunTime time;
      time.month = month, time.day = 15, time.hour = hour;
      const Site site{glm::radians(52.53), glm::radians(118.05), glm::radians(105.0)};
      const Vec3 handbook = sunDirection(sunAngles(time, site));
      time.year = 2001;
      EXPECT_GT(glm::dot(handbook, sunDirection(sunAngles(time, site))), std::cos(glm::radians(1.2))) << month;
    }
  }
}

TEST(SunAngles, AlmanacGivesPublishedPositions) {
  // The equation of time of 3 November is 16.4 minutes, of 11 February -14.2: the sun crosses the meridian then.
  SunTime time;
  time.year = 2000;
  const Site greenwich{glm::radians(51.48), 0, 0};
  time.month = 11, time.day = 3, time.hour = 12 - 16.4 / 60;
  EXPECT_NEAR(glm::degrees(sunAngles(time, greenwich).azimuth), 0, 0.1);
  time.month = 2, time.day = 11, time.hour = 12 + 14.2 / 60;
  EXPECT_NEAR(glm::degrees(sunAngles(time, greenwich).azimuth), 0, 0.1);
}

TEST(Gensky, PrintsSunAndSkyInOrder) {
  const auto objects = expand("!gensky 7 12 7 -a 52.53 -o 118.05 -m 105 -g .2");
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects[0].name, "solar");
  EXPECT_EQ(objects[1].name, "sun");
  EXPECT_EQ(objects[1].reals[3], 0.5);
  EXPECT_EQ(objects[2].name, "skyfunc");
  EXPECT_GT(objects[1].reals[0], 0.7);  // an early summer morning: the sun stands in the east, low
  EXPECT_GT(objects[1].reals[2], 0.1);
  EXPECT_LT(objects[1].reals[2], 0.4);
}

TEST(Gensky, TheSkysIntegralIsWhatItsGroundSays) {
  // With reflectance 1 and no sun the ground's radiance is the sky's horizontal irradiance over pi. The polynomials are
  // fits; the blend at the horizon takes a little.
  for (const double altitude : {20.0, 45.0, 70.0}) {
    for (const char* kind : {"-s -r 0", "-i -r 0", "-c", "-u"}) {
      const RadianceSky sky = skyOfCommand("-ang " + std::to_string(altitude) + " 30 " + kind + " -g 1");
      EXPECT_NEAR(horizontalIrradiance(sky) / (kPi * sky.ground), 1, 0.05) << kind << " " << altitude;
    }
  }
}

TEST(Gensky, BrightnessesMayBeGiven) {
  EXPECT_DOUBLE_EQ(skyOfCommand("-ang 45 0 -c -b 10").zenith, 10);
  EXPECT_NEAR(kPi * skyOfCommand("-ang 45 0 -u -B 30 -g 1").ground, 30, 1e-9);
  EXPECT_NEAR(kPi * skyOfCommand("-ang 45 0 -c -B 30 -g 1").ground, 30, 1e-9);
  EXPECT_NEAR(kPi * skyOfCommand("-ang 45 0 -s -r 0 -B 30 -g 1").ground, 30, 1e-9);
  const auto sun = expand("!gensky -ang 30 0 +s -R 600");
  // Horizontal irradiance of the disc: radiance x solid angle x sine of the altitude.
  EXPECT_NEAR(sun[0].reals[0] * 5.98e-5 * 0.5, 600, 1e-9);
  EXPECT_EQ(expand("!gensky -ang 30 0 +s -r 1000")[0].reals[0], 1000);
}

TEST(Gensky, NoSunWithoutOne) {
  for (const char* options : {"-ang 30 0 -s", "-ang 30 0 -c", "-ang 30 0 -u", "-ang 30 0 -i", "-ang -10 0 +s"}) {
    EXPECT_EQ(expand(std::string("!gensky ") + options).size(), 1u) << options;
  }
}

TEST(Gensky, ReadsHoursAndZones) {
  const auto direction = [](const std::string& options) {
    const auto objects = expand("!gensky " + options);
    return Vec3(objects[1].reals[0], objects[1].reals[1], objects[1].reals[2]);
  };
  const std::string site = " -a 40 -o 75";
  EXPECT_EQ(direction("6 21 10:30" + site + " -m 75"), direction("6 21 10.5" + site + " -m 75"));
  EXPECT_EQ(direction("6 21 10EST" + site + " -m 0"), direction("6 21 10" + site + " -m 75"));
  EXPECT_NEAR(direction("6 21 +12" + site).x, 0, 1e-12);
  for (const char* wrong : {"13 1 12", "0 1 12", "6 32 12", "6 21 25", "6 21 12XYZ", "6 21 noon", "6 21 12 -q 3",
                            "6 21 12 -a", "6 21", "6 21 12 -b -1", "6 21 12 -y 1800"}) {
    EXPECT_NE(errorOf(std::string("!gensky ") + wrong), "") << wrong;
  }
}

TEST(Gensky, StopsShortOfTheZenith) {
  EXPECT_NEAR(skyOfCommand("-ang 90 0").sunDirection.z, std::sin(glm::radians(87.0)), 1e-12);
}

}  // namespace
}  // namespace deltalux::io::radiance::test
