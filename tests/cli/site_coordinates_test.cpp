// A scene at a site's coordinates gives what the same scene gives at the origin, through every command.
#include <gtest/gtest.h>

#include <deltalux/image_io.hpp>
#include <deltalux/points.hpp>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::runCli;
using test::TempFolder;

constexpr int kSite = 5200000;

/// A room, its points, view and edits, all `far` along x and y.
struct Site {
  TempFolder folder;
  std::string scene, points, view, luminaire, edits;

  explicit Site(int far) {
    const auto at = [far](double x) { return std::to_string(far + x); };
    scene = folder.write("room.rad",
                         "void plastic grey 0 0 5 .5 .5 .5 0 0\nvoid light glow 0 0 3 10 10 10\n"
                         "!genbox grey room 8 8 3 -i | xform -t " +
                             at(-4) + " " + at(-4) +
                             " 0\n"
                             "!genbox grey box .5 .5 .5 | xform -t " +
                             at(1) + " " + at(1) +
                             " 0\n"
                             "glow sphere lamp 0 0 4 " +
                             at(0) + " " + at(-1) + " 2 .25\n");
    points = folder.write("p.csv", "x,y,z,nx,ny,nz\n" + at(0) + "," + at(0) + ",0,0,0,1\n" + at(1.25) + "," + at(0.5) +
                                       ",1.5,0,0,-1\n" + at(1) + "," + at(1.25) + ",.25,-1,0,0\n");
    view = folder.write("v.vf", "rvu -vtv -vp " + at(-3) + " " + at(-3) + " 1.5 -vd 1 1 -.2 -vu 0 0 1 -vh 60 -vv 60\n");
    folder.write("spot.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 1\n0 90\n0\n900 900\n");
    luminaire = (folder / "spot.ies").string() + "@" + at(2) + "," + at(-2) + ",2.5";
    edits = folder.write("e.json", R"({"edits": [{"op": "transform", "object": "box", "rotate":
        {"axis": [0, 0, 1], "degrees": 90, "about": [)" +
                                       at(0) + ", " + at(0) + ", 0]}}]}");
  }
  std::string run(std::vector<std::string> arguments, const std::string& out) const {
    arguments.insert(arguments.end(), {"-o", (folder / out).string(), "--quiet"});
    const auto result = runCli(arguments);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    return folder / out;
  }
};

std::vector<double> lux(const std::string& file) {
  const PointTable table = readPoints(file);
  const auto column = std::find(table.columns.begin(), table.columns.end(), "lux") - table.columns.begin();
  std::vector<double> values;
  for (const auto& row : table.rows) values.push_back(std::stod(row[static_cast<std::size_t>(column)]));
  return values;
}

void expectSame(const std::vector<double>& far, const std::vector<double>& near, double tolerance) {
  ASSERT_EQ(far.size(), near.size());
  for (std::size_t i = 0; i < far.size(); ++i) {
    EXPECT_GT(near[i], 1) << i;
    EXPECT_NEAR(far[i], near[i], tolerance * near[i]) << i;
  }
}

TEST(SiteCoordinates, ReferenceIsTheSame) {
  const Site far(kSite), near(0);
  const auto of = [](const Site& s) {
    return lux(s.run({"reference", s.scene, "--ies", s.luminaire, "--points", s.points, "--samples", "256"}, "r.csv"));
  };
  expectSame(of(far), of(near), 1e-4);
  EXPECT_NE(test::readText(far.folder / "r.csv").find("5200001.250000,5200000.500000,1.5,"), std::string::npos)
      << "points are echoed as they were written";
}

TEST(SiteCoordinates, SolutionsUpdatesAndPicturesAreTheSame) {
  const Site far(kSite), near(0);
  const auto of = [](const Site& s) {
    const std::string solved = s.run({"solve", s.scene, "--error", "0.3"}, "s.dlx");
    const std::string updated = s.run({"update", solved, "--edits", s.edits}, "u.dlx");
    return std::pair(lux(s.run({"probe", solved, "--points", s.points}, "s.csv")),
                     lux(s.run({"probe", updated, "--points", s.points}, "u.csv")));
  };
  const auto a = of(far), b = of(near);
  expectSame(a.first, b.first, 0.02);
  expectSame(a.second, b.second, 0.02);
  const auto picture = [](const Site& s) {
    return loadImage(s.run({"render", s.folder / "s.dlx", "--view", s.view, "--size", "16x16"}, "p.exr"));
  };
  const Image p = picture(far), q = picture(near);
  EXPECT_NE(p.view.find("-vp 5199997 5199997 1.5 "), std::string::npos) << p.view;
  double difference = 0, sum = 0;
  for (std::size_t i = 0; i < q.pixels.size(); ++i)
    difference += std::abs(gray(p.pixels[i]) - gray(q.pixels[i])), sum += gray(q.pixels[i]);
  EXPECT_GT(sum, 1);
  EXPECT_LT(difference, 0.03 * sum);
}

TEST(SiteCoordinates, InfoTellsThemInFull) {
  const Site far(kSite);
  const auto result = runCli({"info", far.scene, "--ies", far.luminaire});
  EXPECT_EQ(result.exitCode, 0);
  EXPECT_NE(result.out.find("bounds         5199996 5199996 0 to 5200004 5200004 3"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("measured at 5200002 5199998 2.5"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace deltalux
