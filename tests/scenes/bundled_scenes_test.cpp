// Every bundled scene reads without a warning, and the two scenes of the paper's size have that size.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deltalux/io.hpp>
#include <numeric>
#include <string>

#include "support/shared.hpp"

namespace deltalux {
namespace {

ImportedScene loadBundled(const std::string& file) { return loadScene({test::sourceFolder() / "scenes" / file}); }

std::size_t surfaceCount(const ImportReport& report) {
  return std::accumulate(report.surfaces.begin(), report.surfaces.end(), std::size_t{0},
                         [](std::size_t sum, const auto& entry) { return sum + entry.second; });
}

std::size_t countByMaterial(const Scene& scene, auto&& predicate) {
  return static_cast<std::size_t>(std::count_if(scene.primitives.begin(), scene.primitives.end(), [&](const Primitive& p) {
    return predicate(scene[p.material].name);
  }));
}

class BundledScene : public testing::TestWithParam<const char*> {};

TEST_P(BundledScene, ReadsWithoutWarnings) {
  const ImportedScene imported = loadBundled(GetParam());
  EXPECT_TRUE(imported.report.warnings.empty()) << imported.report.warnings.front();
  EXPECT_TRUE(imported.report.ignored.empty());
  EXPECT_FALSE(imported.scene.primitives.empty());
  EXPECT_NO_THROW(validate(imported.scene));
}

INSTANTIATE_TEST_SUITE_P(All, BundledScene,
                         testing::Values("cornell/cornell.rad", "cornell-caustic/cornell-caustic.rad", "ring/ring.rad",
                                         "plates/parallel.rad", "plates/perpendicular.rad", "lodge/morning.rad",
                                         "lodge/night.rad", "street/day.rad", "street/night.rad"));

TEST(Lodge, IsOfThePapersSize) {
  const ImportedScene lodge = loadBundled("lodge/morning.rad");
  const std::size_t surfaces = surfaceCount(lodge.report);
  EXPECT_GE(surfaces, 3500u);
  EXPECT_LE(surfaces, 5000u);
  // Most of what is curved stays curved: a third of the primitives are no polygons.
  EXPECT_LE(lodge.report.surfaces.at("polygon"), surfaces * 2 / 3);
}

TEST(Lodge, HasAFewHundredSpecularPrimitives) {
  const Scene scene = loadBundled("lodge/morning.rad").scene;
  const std::vector<std::string> names = {"brass",    "steel",        "copper", "chrome",
                                          "silvering", "window_glass", "crystal"};
  const std::size_t specular = countByMaterial(
      scene, [&](const std::string& name) { return std::find(names.begin(), names.end(), name) != names.end(); });
  EXPECT_GE(specular, 100u);
  EXPECT_LE(specular, 400u);
}

TEST(Lodge, NightIsMorningWithoutSunAndSky) {
  const Scene morning = loadBundled("lodge/morning.rad").scene;
  const Scene night = loadBundled("lodge/night.rad").scene;
  EXPECT_EQ(night.primitives.size(), morning.primitives.size());
  EXPECT_EQ(night.lights.size() + 3, morning.lights.size());
}

TEST(Street, IsOfThePapersSize) {
  const ImportedScene street = loadBundled("street/day.rad");
  EXPECT_GE(street.report.surfaces.at("polygon"), 47000u);
  EXPECT_LE(street.report.surfaces.at("polygon"), 55000u);
}

TEST(Street, OnlyTheCladdingIsSpecular) {
  const Scene scene = loadBundled("street/day.rad").scene;
  const std::size_t cladding = countByMaterial(scene, [](const std::string& name) { return name == "cladding"; });
  EXPECT_GE(cladding, 500u);
  EXPECT_LE(cladding, 2000u);
}

}  // namespace
}  // namespace deltalux
