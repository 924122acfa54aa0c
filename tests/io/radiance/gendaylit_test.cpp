#include <gtest/gtest.h>

#include "io/radiance/memory_files.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "scene/daylight/perez.hpp"

namespace deltalux::io::radiance::test {
namespace {

using namespace scene;

struct Made {
  DomeLight sky;
  double directNormal = 0;  // of the sun's disc
  double diffuse = 0;       // horizontal, of the sky
};

Made made(const std::string& options) {
  Made result;
  const Scene scene =
      read("!gendaylit " + options + "\nskyfunc glow g 0 0 4 1 1 1 0  g source sky 0 0 4 0 0 1 360").scene;
  for (const Light& light : scene.lights) {
    if (const auto* sun = std::get_if<SunLight>(&light.emitter))
      result.directNormal = sun->radiance.r * solidAngle(*sun);
    if (const auto* dome = std::get_if<DomeLight>(&light.emitter)) result.sky = *dome;
  }
  // Rings of equal height: another rule than the generator's own.
  constexpr int kRings = 400, kSectors = 720;
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kSectors; ++k) {
      const double z = (i + 0.5) / kRings, r = std::sqrt(1 - z * z), azimuth = 2 * kPi * (k + 0.5) / kSectors;
      result.diffuse += 2 * kPi * z * skyRadiance(result.sky, Vec3(r * std::cos(azimuth), r * std::sin(azimuth), z)).r /
                        (kRings * kSectors);
    }
  return result;
}

PerezSky perez(const Made& m) { return std::get<PerezSky>(m.sky.distribution); }

TEST(Gendaylit, SunAndSkyHaveTheIrradiancesAskedFor) {
  for (const char* when : {"6 21 12 -a 42 -o 71 -m 75", "-ang 50 20", "-ang 12 -60", "12 3 +10.5 -a 51 -y 2020"}) {
    for (const auto& [direct, diffuse] : {std::pair(800.0, 90.0), {300.0, 200.0}, {10.0, 150.0}}) {
      const std::string given = std::to_string(direct) + " " + std::to_string(diffuse);
      const Made m = made(std::string(when) + " -O 1 -W " + given);
      EXPECT_NEAR(m.diffuse / diffuse, 1, 0.005) << when << " " << given;
      EXPECT_NEAR(m.directNormal / direct, 1, 0.005) << when << " " << given;
      const Made lit =
          made(std::string(when) + " -L " + std::to_string(100 * direct) + " " + std::to_string(100 * diffuse));
      EXPECT_NEAR(179 * lit.diffuse / (100 * diffuse), 1, 0.005) << when << " " << given;
      EXPECT_NEAR(179 * lit.directNormal / (100 * direct), 1, 0.005) << when << " " << given;
    }
  }
}

TEST(Gendaylit, FormsOfTheSameDaylightAgree) {
  const double altitude = glm::radians(40.0), zenith = kPi / 2 - altitude;
  const SkyCondition condition = conditionOf({600, 120}, zenith, kSolarConstant);
  const Daylight back = daylightOf(condition, kSolarConstant);
  EXPECT_NEAR(back.directNormal, 600, 1e-6);
  EXPECT_NEAR(back.diffuse, 120, 1e-6);
  const Made w = made("-ang 40 0 -W 600 120"),
             p = made("-ang 40 0 -P " + std::to_string(condition.clearness) + " " +
                      std::to_string(condition.brightness)),
             g = made("-ang 40 0 -G " + std::to_string(600 * std::sin(altitude)) + " 120");
  for (const Made* other : {&p, &g}) {
    EXPECT_NEAR(other->directNormal / w.directNormal, 1, 1e-4);
    EXPECT_NEAR(other->diffuse / w.diffuse, 1, 1e-4);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(perez(*other).coefficients[i], perez(w).coefficients[i], 1e-3) << i;
  }
  // Illuminances over irradiances are the efficacies, and -O 2 is 179 times -O 0.
  const Daylight K = efficacies(condition, 2);
  EXPECT_NEAR(179 * w.directNormal / 600 / K.directNormal, 1, 0.005);
  EXPECT_NEAR(179 * w.diffuse / 120 / K.diffuse, 1, 0.005);
  EXPECT_NEAR(made("-ang 40 0 -O 2 -W 600 120").diffuse / w.diffuse, 179, 0.1);
  // Global horizontal irradiance is divided, not changed.
  const Made e = made("-ang 40 0 -O 1 -E 500");
  EXPECT_NEAR(e.diffuse + e.directNormal * std::sin(altitude), 500, 3);
}

TEST(Gendaylit, CoefficientsAreThoseOfTheirBins) {
  // Clearness 8, brightness .1, sun at 40 degrees from the zenith: a + b Z + Delta (c + d Z) of the last bin.
  const double Z = glm::radians(40.0);
  const auto x = perezCoefficients({Z, 8, 0.1});
  EXPECT_NEAR(x[0], -1.05 + 0.0289 * Z + 0.1 * (0.426 + 0.359 * Z), 1e-12);
  EXPECT_NEAR(x[2], 31.0625 - 14.5 * Z + 0.1 * (-46.1148 + 55.375 * Z), 1e-12);
  // Overcast: c and d by exponentials.
  const auto y = perezCoefficients({Z, 1, 0.2});
  EXPECT_NEAR(y[2], std::exp(std::pow(0.2 * (2.8 + 0.6004 * Z), 1.2375)) - 1, 1e-12);
  EXPECT_NEAR(y[3], -std::exp(0.2 * (1.8734 + 0.6297 * Z)) + 0.9738 + 0.2 * 0.2809, 1e-12);
  // Overcast skies brighten towards the zenith, clear ones towards the sun and the horizon.
  const Made overcast = made("-ang 40 0 -P 1 .2"), clear = made("-ang 40 0 -P 8 .1");
  const auto at = [](const Made& m, double altitude, double azimuth) {
    const double a = glm::radians(altitude), b = glm::radians(azimuth);
    return skyRadiance(m.sky, Vec3(-std::sin(b) * std::cos(a), -std::cos(b) * std::cos(a), std::sin(a))).r;
  };
  EXPECT_GT(at(overcast, 90, 0), 1.5 * at(overcast, 5, 90));
  EXPECT_GT(at(clear, 40, 0), 4 * at(clear, 90, 0));
  EXPECT_GT(at(clear, 5, 120), at(clear, 60, 180));
}

TEST(Gendaylit, WithoutASunThereIsNone) {
  EXPECT_EQ(made("-ang 40 0 -s -W 600 120").directNormal, 0);
  EXPECT_EQ(made("-ang 40 0 -W 0 120").directNormal, 0);
  const Made night = made("-ang -10 0 -W 600 120");
  EXPECT_EQ(night.directNormal, 0);
  EXPECT_EQ(night.diffuse, 0);
  const auto ground = [](const std::string& options) {
    return perez(made("-ang 40 0 -O 1 -W 600 120 " + options)).ground;
  };
  EXPECT_NEAR(ground("-g .3"), 0.3 * (120 + 600 * std::sin(glm::radians(40.0))) / kPi, 1e-6);
  EXPECT_NEAR(ground("-s"), 0.2 * 120 / kPi, 1e-6);
}

TEST(Gendaylit, WrongArgumentsAreInputErrors) {
  for (const char* options : {"", "-ang 40 0", "6 21 12", "13 1 12 -W 1 1", "-ang 40 0 -W 1", "-ang 40 0 -W -1 5",
                              "-ang 40 0 -W 1 1 -O 3", "-ang 40 0 -W 1 1 -C", "-ang 40 0 -W 1 nan"})
    EXPECT_NE(errorOf(std::string("!gendaylit ") + options), "") << options;
}

}  // namespace
}  // namespace deltalux::io::radiance::test
