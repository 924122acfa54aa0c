#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deltalux/grid.hpp>
#include <deltalux/io.hpp>
#include <deltalux/points.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::bundledScene;
using test::runCli;
using test::TempFolder;

/// A luminaire whose light differs from plane to plane.
std::string luminaire() {
  std::string ies = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 19 5 1 2 0 0 0\n1 1 10\n", candela;
  for (int v = 0; v <= 90; v += 5) ies += fmt::format("{} ", v);
  ies += "\n0 45 90 135 180\n";
  for (int h = 0; h <= 180; h += 45) {
    for (int v = 0; v <= 90; v += 5)
      candela += fmt::format("{:.3f} ", (2000 + 4 * h) * std::cos(v * kPi / 180) * (1 + 0.01 * v));
    candela += "\n";
  }
  return ies + candela;
}

TEST(GridCommand, TellsTheAnalyticMeanAndUniformityOfALuminaire) {
  const TempFolder folder;
  folder.write("black.rad",
               "void plastic black\n0\n0\n5 0 0 0 0 0\nblack polygon floor\n0\n0\n12 0 0 0 6 0 0 6 5 0 0 5 0\n");
  folder.write("lamp.ies", luminaire());
  const auto result = runCli({"grid", folder / "black.rad", "--ies", (folder / "lamp.ies").string() + "@2.5,2,2.8",
                              "--surface", "floor", "-o", folder / "g.csv", "--plan", folder / "g.svg"});
  ASSERT_EQ(result.exitCode, 0) << result.err;

  const Photometry photometry = loadPhotometry(folder / "lamp.ies");
  const MeasuringGrid grid = gridOf({{0, 0, 0}, {6, 0, 0}, {0, 5, 0}}, 1);
  std::vector<double> lux;
  for (const ProbePoint& p : grid.points) {
    const Vec3 d = p.position - Vec3(2.5, 2, 2.8);
    const double r = glm::length(d), gamma = std::acos(-d.z / r) * 180 / kPi;
    double plane = std::atan2(d.y, d.x) * 180 / kPi;
    if (plane < 0) plane += 360;
    lux.push_back(candela(photometry, gamma, plane) * (-d.z / r) / (r * r));
  }
  const GridStatistics exact = statisticsOf(lux);
  double mean = 0, least = 0, most = 0, uniformity = 0, diversity = 0;
  const std::size_t at = result.out.find("Em ");
  ASSERT_NE(at, std::string::npos) << result.out;
  ASSERT_EQ(std::sscanf(result.out.c_str() + at, "Em %lf lx, Emin %lf lx, Emax %lf lx, U0 %lf, Ud %lf", &mean, &least,
                        &most, &uniformity, &diversity),
            5)
      << result.out;
  EXPECT_NEAR(mean, exact.mean, 0.01 * exact.mean);
  EXPECT_NEAR(uniformity, exact.uniformity(), 0.01 * exact.uniformity() + 0.0005);
  EXPECT_NEAR(diversity, exact.diversity(), 0.01 * exact.diversity() + 0.0005);
  EXPECT_NE(result.out.find(fmt::format("{} points", lux.size())), std::string::npos) << result.out;
  EXPECT_EQ(readPoints(folder / "g.csv").points.size(), lux.size());
  EXPECT_NE(test::readText(folder / "g.svg").find("</svg>"), std::string::npos);
}

TEST(GridCommand, InAnEvenFieldAllIlluminancesAreOne) {
  const auto result = runCli({"grid", bundledScene("furnace/furnace.gltf"), "--area", "0.4,0.5,0.6,0.2,0,0,0,0,-0.2",
                              "--spacing", "0.1", "--border", "0", "--cylindrical", "--kind", "office"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.out.find("required at least 500 lx: pass"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("required at least 0.6: pass"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("required at least 150 lx: pass"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("4 points, 2 x 2, 0.1 x 0.1 m apart"), std::string::npos) << result.out;
  double least = 0, most = 0;
  const std::size_t at = result.out.find("modelling: ");
  ASSERT_NE(at, std::string::npos) << result.out;
  ASSERT_EQ(std::sscanf(result.out.c_str() + at, "modelling: %*f (%lf to %lf)", &least, &most), 2) << result.out;
  EXPECT_NEAR(least, 1, 0.03);
  EXPECT_NEAR(most, 1, 0.03);
}

TEST(GridCommand, MistakesAreToldBeforeSolving) {
  const std::string scene = bundledScene("cornell/cornell.rad");
  const TempFolder folder;
  test::expectUsageError({"grid", scene});
  test::expectUsageError({"grid", scene, "--area", "0,0,0,1,0,0,0.5,1,0"});
  test::expectUsageError({"grid", scene, "--area", "0,0,0,1,0"});
  test::expectUsageError({"grid", scene, "--surface", "floor", "--area", "0,0,0,1,0,0,0,1,0"});
  test::expectUsageError({"grid", scene, "--surface", "floor", "--plan", folder / "plan.jpg"});
  const auto result = runCli({"grid", scene, "--surface", "flor"});
  EXPECT_EQ(result.exitCode, 3);
  EXPECT_NE(result.err.find("floor"), std::string::npos) << result.err;
  EXPECT_EQ(runCli({"grid", scene, "--surface", "floor", "-o", folder / "none/g.csv"}).exitCode, 4);
}

}  // namespace
}  // namespace deltalux
