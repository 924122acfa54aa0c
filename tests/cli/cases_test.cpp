// Small scenes of the shared folder, each after a kind of fault met with real files, and the illuminance that is right
// there: closed forms, or the reference integrator's (cases/README.md). 5 %, as that page asks.
#include <gtest/gtest.h>

#include <deltalux/points.hpp>

#include "support/run_cli.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

struct Case {
  const char* scene;
  const char* points;       // a file beside the scene, or the rows themselves
  std::vector<double> lux;  // right values of the first points; below 0: any
  std::vector<std::string> options = {};
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.scene; }

class Cases : public testing::TestWithParam<Case> {};

TEST_P(Cases, IlluminanceIsRight) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const std::filesystem::path cases = shared / "cases";
  if (!exists(cases / GetParam().scene)) GTEST_SKIP() << "no " << cases / GetParam().scene;
  const test::TempFolder folder;
  const std::string points = GetParam().points;
  std::vector<std::string> arguments{"probe",
                                     (cases / GetParam().scene).string(),
                                     "--points",
                                     points.ends_with(".csv")
                                         ? (cases / points).string()
                                         : folder.write("p.csv", "x,y,z,nx,ny,nz\n" + points + "\n").string(),
                                     "-o",
                                     folder / "o.csv"};
  arguments.insert(arguments.end(), GetParam().options.begin(), GetParam().options.end());
  const test::CliResult result = test::runCli(arguments);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const PointTable table = readPoints(folder / "o.csv");
  const auto lux = std::find(table.columns.begin(), table.columns.end(), "lux") - table.columns.begin();
  ASSERT_GE(table.rows.size(), GetParam().lux.size());
  for (std::size_t i = 0; i < GetParam().lux.size(); ++i) {
    const double right = GetParam().lux[i];
    if (right < 0) continue;
    EXPECT_NEAR(std::stod(table.rows[i][static_cast<std::size_t>(lux)]), right, 0.05 * right) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    RealFiles, Cases,
    testing::Values(
        Case{"large-ground.rad", "large-ground.csv", {1231, 1234, 2156, 201, 311, 1406, 1130}, {"--error", "0.01"}},
        Case{"hole-winding.rad", "hole-winding.csv", {-1, 543}},
        Case{"brightdata-downlight.rad", "brightdata-downlight.csv", {250}},
        Case{"perez-sky.rad", "perez-sky.csv", {7888}}, Case{"glow-negative.rad", "0,0,0,0,0,1", {0}},
        Case{"utm.rad", "utm.csv", {413.2, 278.5, 1347}}, Case{"alpha-blend-60.gltf", "alpha-blend.csv", {125}},
        Case{"alpha-blend-reflects.gltf", "alpha-blend.csv", {500, 500}},
        Case{"efficacy-spot.gltf", "0,0,0,0,1,0", {100}, {"--efficacy", "683"}},
        Case{"mtl/ke_one.obj", "mtl/points.csv", {413.2, 278.5}}, Case{"mtl/bom.obj", "mtl/points.csv", {413.2, 278.5}},
        Case{"mtl/cr.obj", "mtl/points.csv", {413.2, 278.5}}, Case{"mtl/pane_dhalo.obj", "mtl/points.csv", {310}},
        Case{"mtl/pane_tr25.obj", "mtl/points.csv", {-1, 69.6}}),
    [](const auto& tested) {
      std::string name = tested.param.scene;
      std::replace_if(
          name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
      return name;
    });

}  // namespace
}  // namespace deltalux
