#include <fmt/format.h>
#include <gtest/gtest.h>

#include <deltalux/design.hpp>
#include <deltalux/edit_io.hpp>
#include <sstream>

#include "support/run_cli.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using test::runCli;
using test::TempFolder;

constexpr int kLamps = 4, kPoints = 10;

std::string rectangle(const std::string& material, const std::string& name, const Vec3& at, const Vec3& u,
                      const Vec3& v) {
  std::string text = fmt::format("{} polygon {}\n0\n0\n12", material, name);
  for (const Vec3& p : {at, at + u, at + u + v, at + v}) text += fmt::format(" {} {} {}", p.x, p.y, p.z);
  return text + "\n";
}

/// A room of 6 x 5 x 3 m, lit by four lamps below its ceiling; `shift`: of the first one, along x.
std::string roomWithFourLamps(double shift = 0) {
  std::string text = "void plastic paint\n0\n0\n5 .6 .6 .6 0 0\n";
  text += rectangle("paint", "floor", {0, 0, 0}, {6, 0, 0}, {0, 5, 0});
  text += rectangle("paint", "ceiling", {0, 0, 3}, {0, 5, 0}, {6, 0, 0});
  text += rectangle("paint", "south", {0, 0, 0}, {0, 0, 3}, {6, 0, 0});
  text += rectangle("paint", "north", {0, 5, 0}, {6, 0, 0}, {0, 0, 3});
  text += rectangle("paint", "west", {0, 0, 0}, {0, 5, 0}, {0, 0, 3});
  text += rectangle("paint", "east", {6, 0, 0}, {0, 0, 3}, {0, 5, 0});
  for (int i = 0; i < kLamps; ++i) {
    const Vec3 at(i % 2 == 0 ? 1.2 : 4.2, i < 2 ? 1 : 3.4, 2.9);
    text += fmt::format("void light glow{}\n0\n0\n3 {} {} {}\n", i, 20 + 5 * i, 20 + 5 * i, 20 + 5 * i);
    text += rectangle(fmt::format("glow{}", i), fmt::format("lamp{}", i), at + Vec3(i == 0 ? shift : 0, 0, 0),
                      {0, 0.5, 0}, {0.5, 0, 0});
  }
  return text;
}

Vec3 pointOf(int i) { return {0.8 + 1.1 * (i % 5), i < 5 ? 1.3 : 3.6, 0}; }

/// CSV of the points, with targets where there are any.
std::string pointsWith(const std::vector<double>& targets = {}) {
  std::string text = targets.empty() ? "name,x,y,z,nx,ny,nz\n" : "name,x,y,z,nx,ny,nz,target\n";
  for (int i = 0; i < kPoints; ++i) {
    text += fmt::format("desk{},{},{},0,0,0,1", i, pointOf(i).x, pointOf(i).y);
    text += targets.empty() ? "\n" : fmt::format(",{}\n", targets[static_cast<std::size_t>(i)]);
  }
  return text;
}

/// Values of those columns whose name starts with `prefix`, by column.
std::vector<std::vector<double>> columnsOf(const std::string& csv, const std::string& prefix) {
  std::vector<std::size_t> which;
  std::vector<std::vector<double>> columns;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields;
    std::istringstream words(line);
    for (std::string field; std::getline(words, field, ',');) fields.push_back(field);
    if (columns.empty()) {
      for (std::size_t i = 0; i < fields.size(); ++i)
        if (fields[i].starts_with(prefix)) which.push_back(i), columns.emplace_back();
      if (columns.empty()) return columns;
      continue;
    }
    for (std::size_t k = 0; k < which.size(); ++k) columns[k].push_back(std::stod(fields[which[k]]));
  }
  return columns;
}

/// The scale that edits set each lamp to.
std::vector<double> weightsIn(const std::string& file) {
  std::vector<double> weights(kLamps, -1);
  for (const EditStep& step : loadEdits(file))
    if (const auto* dim = std::get_if<ColourLight>(&std::get<Edit>(step)))
      weights.at(static_cast<std::size_t>(dim->light.at(4) - '0')) = gray(dim->rgb);
  return weights;
}

class DesignCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    folder.write("room.rad", roomWithFourLamps());
    folder.write("points.csv", pointsWith());
    ASSERT_EQ(
        runCli({"solve", folder / "room.rad", "--by-light", "--error", "0.03", "-o", folder / "room.dlx"}).exitCode, 0);
    ASSERT_EQ(
        runCli({"probe", folder / "room.dlx", "--by-light", "--points", folder / "points.csv", "-o", folder / "a.csv"})
            .exitCode,
        0);
    brings = columnsOf(test::readText(folder / "a.csv"), "lux_");
    ASSERT_EQ(brings.size(), std::size_t(kLamps));
  }

  test::CliResult design(const std::vector<double>& targets, const std::vector<std::string>& more = {}) {
    folder.write("targets.csv", pointsWith(targets));
    std::vector<std::string> words{"design", folder / "room.dlx",  "--targets", folder / "targets.csv",
                                   "-o",     folder / "edits.json"};
    words.insert(words.end(), more.begin(), more.end());
    return runCli(words);
  }

  TempFolder folder;
  std::vector<std::vector<double>> brings;  // by lamp, at each point [lux]
};

TEST_F(DesignCommand, FindsWhatTenTargetsWereMadeOfByFourLamps) {
  const std::vector<double> made{0.3, 0.7, 1.0, 0.5};
  std::vector<double> targets(kPoints, 0.0);
  for (std::size_t p = 0; p < targets.size(); ++p)
    for (std::size_t g = 0; g < made.size(); ++g) targets[p] += made[g] * brings[g][p];
  const test::CliResult result = design(targets);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("all 10 targets are met"), std::string::npos) << result.err;
  const std::vector<double> weights = weightsIn(folder / "edits.json");
  for (std::size_t g = 0; g < made.size(); ++g) EXPECT_NEAR(weights[g], made[g], 0.02) << g;
}

TEST_F(DesignCommand, NamesTargetsThatCannotBeMetAndDoesTheBestForAll) {
  std::vector<double> targets(kPoints, 0.0);
  for (std::size_t p = 0; p < targets.size(); ++p)
    for (const std::vector<double>& lamp : brings) targets[p] += 0.5 * lamp[p];
  targets[3] *= 20;
  const Dimmed exact = bestDimming(brings, targets);
  const test::CliResult result = design(targets);
  ASSERT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("cannot be met: desk3"), std::string::npos) << result.err;
  const std::vector<double> weights = weightsIn(folder / "edits.json");
  for (std::size_t g = 0; g < weights.size(); ++g) EXPECT_NEAR(weights[g], exact.weights[g], 0.03) << g;
}

TEST_F(DesignCommand, FindsWhereALampIsBestAlongALine) {
  folder.write("moved.rad", roomWithFourLamps(1.2));
  ASSERT_EQ(runCli({"probe", folder / "moved.rad", "--error", "0.03", "--points", folder / "points.csv", "-o",
                    folder / "m.csv"})
                .exitCode,
            0);
  const auto lux = columnsOf(test::readText(folder / "m.csv"), "lux");
  ASSERT_FALSE(lux.empty());
  const test::CliResult result = design(lux.front(), {"--along", "lamp0=2,0,0"});
  ASSERT_EQ(result.exitCode, 0) << result.err;
  const auto steps = loadEdits(folder / "edits.json");
  const auto* move = std::get_if<MoveLight>(&std::get<Edit>(steps.front()));
  ASSERT_NE(move, nullptr);
  EXPECT_NEAR(move->offset.x, 1.2, 0.15);
  EXPECT_NE(result.err.find("all 10 targets are met"), std::string::npos) << result.err;
  EXPECT_EQ(design(lux.front(), {"--along", "lamp7=2,0,0"}).exitCode, 3);
}

}  // namespace
}  // namespace deltalux
