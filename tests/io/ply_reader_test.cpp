// Meshes of PLY in all their encodings.
#include "io/ply.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <deltalux/error.hpp>

#include "io/gunzip.hpp"
#include "io/import_file.hpp"
#include "io/mitsuba.hpp"
#include "support/shared.hpp"
#include "support/temp_folder.hpp"

namespace deltalux {
namespace {

using Ignored = std::map<std::string, std::size_t>;

const std::string kSquare =
    "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

Mesh read(const std::string& text) {
  Ignored ignored;
  return io::readPly(text, "a.ply", ignored);
}

double areaOf(const Mesh& mesh) {
  const auto made = makeMesh(mesh.positions, mesh.triangles);
  return made ? made->cumulativeArea.back() : 0;
}

std::string gzipped(const std::string& text) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  std::string packed(text.size() + 1000, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

template <class T>
void put(std::string& bytes, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (big) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// A triangle and a quad with normals and texture coordinates, amid properties that nobody reads.
std::string binary(bool big) {
  std::string bytes = std::string("ply\r\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\r\nelement vertex 5\r\nproperty double x\r\nproperty float y\r\nproperty short z\r\n"
                      "property list uchar char tags\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n"
                      "property uchar red\r\nproperty float s\r\nproperty float t\r\nelement edge 1\r\n"
                      "property int a\r\nelement face 2\r\nproperty ushort flags\r\n"
                      "property list uint ushort vertex_index\r\nend_header\n";
  const double corners[5][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {3, 1}};
  for (int i = 0; i < 5; ++i) {
    put(bytes, corners[i][0], big), put(bytes, static_cast<float>(corners[i][1]), big),
        put(bytes, std::int16_t{-7}, big);
    put(bytes, std::uint8_t{2}, big), put(bytes, std::int8_t{1}, big), put(bytes, std::int8_t{-1}, big);
    put(bytes, 0.0f, big), put(bytes, 0.0f, big), put(bytes, 2.0f, big), put(bytes, std::uint8_t{255}, big);
    put(bytes, 0.25f * static_cast<float>(i), big), put(bytes, 0.5f, big);
  }
  put(bytes, std::int32_t{3}, big);
  put(bytes, std::uint16_t{9}, big), put(bytes, std::uint32_t{4}, big);
  for (const int i : {0, 1, 2, 3}) put(bytes, static_cast<std::uint16_t>(i), big);
  put(bytes, std::uint16_t{9}, big), put(bytes, std::uint32_t{3}, big);
  for (const int i : {1, 4, 2}) put(bytes, static_cast<std::uint16_t>(i), big);
  return bytes;
}

TEST(PlyReader, TextIsRead) {
  const Mesh mesh = read(kSquare);
  EXPECT_EQ(mesh.positions.size(), 4u);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_NEAR(areaOf(mesh), 1, 1e-12);
  EXPECT_TRUE(mesh.normals.empty());
  EXPECT_TRUE(mesh.texcoords.empty());
}

TEST(PlyReader, BinariesOfBothByteOrdersAreOneMesh) {
  for (const bool big : {false, true}) {
    Ignored ignored;
    const Mesh mesh = io::readPly(binary(big), "a.ply", ignored);
    ASSERT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.positions[4], Vec3(3, 1, -7));
    EXPECT_EQ(mesh.triangles.size(), 3u);
    EXPECT_NEAR(areaOf(mesh), 5, 1e-12);
    ASSERT_EQ(mesh.normals.size(), 5u);
    EXPECT_EQ(mesh.normals[3], Vec3(0, 0, 1));
    ASSERT_EQ(mesh.texcoords.size(), 5u);
    EXPECT_EQ(mesh.texcoords[2], Vec2(0.5, 0.5));
    EXPECT_EQ(ignored, (Ignored{{"PLY's element edge", 1}}));
  }
}

TEST(PlyReader, GzipIsUnpacked) {
  EXPECT_NEAR(areaOf(read(gzipped(kSquare))), 1, 1e-12);
  EXPECT_EQ(io::gunzip(gzipped(binary(true)), "a"), binary(true));
  const std::string packed = gzipped(kSquare);
  EXPECT_THROW(read(packed.substr(0, packed.size() - 12)), InputError);
  EXPECT_THROW(read(packed.substr(0, 10) + "damage" + packed.substr(16)), InputError);
}

TEST(PlyReader, FacesOfManyCornersAndWithoutAreaAreTaken) {
  Ignored ignored;
  // An L of six corners, concave; a line; an edge.
  const Mesh mesh = io::readPly(
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nelement face 3\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 2 0 0 2 1 0 1 1 0 1 2 0 0 2 0\n6 0 1 2 3 4 5\n"
      "3 0 1 1\n2 0 1\n",
      "a.ply", ignored);
  EXPECT_NEAR(areaOf(mesh), 3, 1e-12);
  EXPECT_EQ(ignored, (Ignored{{"faces of fewer than 3 corners", 1}, {"faces without area", 1}}));
}

TEST(PlyReader, MistakesAreInputErrorsWithTheirLine) {
  const auto expect = [](std::string text, const std::string& part, const std::string& with, int line,
                         const std::string& words) {
    const std::size_t at = text.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    text.replace(at, part.size(), with);
    try {
      read(text);
      ADD_FAILURE() << "was read: " << text;
    } catch (const InputError& error) {
      EXPECT_NE(error.message().find(words), std::string::npos) << error.message();
      EXPECT_EQ(error.line(), line) << error.message();
      EXPECT_FALSE(error.hint().empty());
    }
  };
  expect(kSquare, "ply\n", "plx\n", 1, "no PLY");
  expect(kSquare, "ascii", "binary", 2, "'binary'");
  expect(kSquare, "format ascii 1.0", "", 10, "no format");
  expect(kSquare, "vertex 4", "vertex -4", 4, "count");
  expect(kSquare, "vertex 4", "vertex 9999999999", 4, "count");
  expect(kSquare, "float x", "real x", 5, "'real'");
  expect(kSquare, "list uchar", "list float", 9, "no integer");
  expect(kSquare, "end_header", "", 11, "no word");
  expect(kSquare, "property float z\n", "", 4, "no x, y, z");
  expect(kSquare, "vertex_indices", "corners", 8, "vertex_indices");
  expect(kSquare, "1 1 0", "1 one 0", 13, "not a number");
  expect(kSquare, "1 1 0", "1 1e20 0", 13, "beyond all bounds");
  expect(kSquare, "0 1 2 3\n", "0 1 2 4\n", 15, "vertex 4 of 4");
  expect(kSquare, "0 1 2 3\n", "0 1 2 -1\n", 15, "integer");
  expect(kSquare, "4 0 1 2 3\n", "5 0 1 2 3\n", 16, "ends before");
  expect(kSquare, "4 0 1 2 3\n", "70000 0 1 2 3\n", 15, "too many corners");
  expect(kSquare.substr(0, kSquare.find("property")), "ply", "ply", 4, "ends within its header");
  EXPECT_THROW(read(binary(false).substr(0, binary(false).size() - 1)), InputError);
}

TEST(PlyReader, MitsubaTakesIt) {
  const test::TempFolder folder;
  folder.write("square.ply", kSquare);
  const auto file = folder.write("scene.xml", R"(<scene version="3.0.0"><shape type="ply"><string name="filename"
    value="square.ply"/><transform name="to_world"><scale value="3"/></transform></shape></scene>)");
  const Scene scene = loadScene({file}).scene;
  ASSERT_EQ(scene.primitives.size(), 1u);
  EXPECT_NEAR(std::get<Polygon>(scene.primitives[0].shape).area, 9, 1e-9);
}

TEST(PlyReader, CasesOfTheFuzzerAreReadOrRefused) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() / "fuzz/corpus/ply")) {
    ++count;
    try {
      read(io::readInputFile(entry.path()));
    } catch (const InputError& error) {
      EXPECT_FALSE(error.message().empty());
    }
  }
  EXPECT_GE(count, 2u);
}

}  // namespace
}  // namespace deltalux
