#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <deltalux/points.hpp>
#include <deltalux/units.hpp>

#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

InputError errorOf(const std::string& text) {
  try {
    parsePoints(text, "p.csv");
  } catch (const InputError& error) {
    return error;
  }
  ADD_FAILURE() << "no error for: " << text;
  return {"", 0, ""};
}

TEST(Points, ReadsAnyColumnOrderCommentsAndBlankLines) {
  const PointTable table = parsePoints(
      "\xef\xbb\xbf# made by hand\n\nname, nx,ny,nz ,z,y,x\r\n# and more\n\"a, b\",0,0,2,3,+2,1e0\r\nc,1,1,0,-3,0.5,-1",
      "p.csv");
  ASSERT_EQ(table.points.size(), 2u);
  EXPECT_EQ(table.points[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(table.points[0].normal, Vec3(0, 0, 1));
  EXPECT_EQ(table.rows[0][0], "\"a, b\"");
  EXPECT_EQ(table.points[1].position, Vec3(-1, 0.5, -3));
  EXPECT_NEAR(table.points[1].normal.x, std::sqrt(0.5), 1e-15);
}

TEST(Points, MistakesNameTheirLine) {
  const std::string head = "# c\nx,y,z,nx,ny,nz\n";
  EXPECT_EQ(errorOf("").message(), "there is no header row");
  EXPECT_NE(errorOf("x,y,z,nx,ny\n1,2,3,0,0\n").message().find("no column nz"), std::string::npos);
  EXPECT_NE(errorOf("x,y,z,x,nx,ny,nz\n").message().find("x twice"), std::string::npos);
  EXPECT_NE(errorOf(head).message().find("no points"), std::string::npos);
  EXPECT_EQ(errorOf(head + "1,2,3,0,0,1\n1,2,3,0,0\n").line(), 4);
  EXPECT_EQ(errorOf(head + "1,2,3,0,0,1,9\n").line(), 3);
  for (const char* number : {"abc", "", "1e999", "nan", "inf", "1.5x", "1 2", "0x10", "--1"})
    EXPECT_EQ(errorOf(head + "\n" + number + ",2,3,0,0,1\n").line(), 4) << number;
  EXPECT_NE(errorOf(head + "1,2,3,0,0,0\n").message().find("normal"), std::string::npos);
}

TEST(Points, NormalsOfAnySizeBecomeUnit) {
  for (const char* size : {"1e-320", "1e-200", "3", "1e300"}) {
    const std::string text = std::string("x,y,z,nx,ny,nz\n0,0,0,0,") + size + "," + size + "\n";
    EXPECT_NEAR(parsePoints(text, "p.csv").points[0].normal.y, std::sqrt(0.5), 1e-12) << size;
  }
}

TEST(Points, MissingFilesAndFoldersAreInputErrors) {
  const test::TempFolder folder;
  EXPECT_THROW(readPoints(folder / "none.csv"), InputError);
  EXPECT_THROW(readPoints(folder.path()), InputError);
}

TEST(Points, ResultsAreTheSameRowsPlusColumns) {
  const PointTable table = parsePoints("id,x,y,z,nx,ny,nz,wall\n7,1.50,2,3,0,0,1,\"north, left\"\n", "p.csv");
  const std::vector<ProbeResult> results{{{1.25, 2, 3}, {0.01, 0.02, 0.03}, 10}};
  EXPECT_NEAR(photometric({1.25, 2, 3}, 179), 179 * (0.265 * 1.25 + 0.670 * 2 + 0.065 * 3), 1e-9);
  const std::string text = formatProbeResults(table, results);
  EXPECT_EQ(text,
            "id,x,y,z,nx,ny,nz,wall,E_r,E_g,E_b,lux,se_r,se_g,se_b\n"
            "7,1.50,2,3,0,0,1,\"north, left\",1.25,2,3,334.0588,0.01,0.02,0.03\n");
  EXPECT_NE(formatProbeResults(table, results, 683), text) << "lux by the scene's efficacy";
}

TEST(Points, ColumnsOfEarlierResultsAreReplaced) {
  const PointTable table = parsePoints("x,y,z,nx,ny,nz,E_r,lux,note\n1,2,3,0,0,1,99,98,hi\n", "p.csv");
  const std::vector<ProbeResult> results{{{1, 1, 1}, {0, 0, 0}, 1}};
  EXPECT_EQ(formatProbeResults(table, results),
            "x,y,z,nx,ny,nz,note,E_r,E_g,E_b,lux,se_r,se_g,se_b\n1,2,3,0,0,1,hi,1,1,1,179,0,0,0\n");
}

TEST(Points, ResultsCanBeReadAgainAsPoints) {
  const test::TempFolder folder;
  const PointTable table = parsePoints("x,y,z,nx,ny,nz\n1,2,3,0,0,1\n4,5,6,1,0,0\n", "p.csv");
  writeProbeResults(folder / "out.csv", table, std::vector<ProbeResult>(2), 179);
  const PointTable again = readPoints(folder / "out.csv");
  ASSERT_EQ(again.points.size(), 2u);
  EXPECT_EQ(again.points[1].position, Vec3(4, 5, 6));
}

TEST(Points, ReadsTheReferenceFiles) {
  DELTALUX_SHARED_OR_SKIP(shared);
  EXPECT_EQ(readPoints(shared / "reference/cabin.csv").points.size(), 303u);
  EXPECT_GT(readPoints(shared / "reference/cornell.csv").points.size(), 100u);
}

}  // namespace
}  // namespace deltalux
