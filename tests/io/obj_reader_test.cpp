#include "io/obj.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <deltalux/error.hpp>
#include <filesystem>
#include <fstream>

#include "support/temp_folder.hpp"

namespace deltalux {
using namespace io;

namespace {

ImportedScene read(const std::string& text, const std::filesystem::path& folder = "/nonexistent") {
  ImportedScene imported = readObj(text, "scene.obj", folder, {});
  validate(imported.scene);
  return imported;
}

double totalArea(const Scene& scene) {
  double sum = 0;
  for (const Primitive& primitive : scene.primitives) sum += area(primitive.shape);
  return sum;
}

class ObjFiles : public testing::Test {
 protected:
  void write(const std::string& name, const std::string& content) {
    std::ofstream(folder_.path() / name, std::ios::binary) << content;
  }
  Material materialOf(const std::string& mtl) {
    write("m.mtl", "newmtl a\n" + mtl);
    imported_ = read("mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n",
                     folder_.path());
    return imported_.scene.materialOf(PrimitiveId(0));
  }
  const test::TempFolder folder_;
  ImportedScene imported_;
};

TEST(ObjReader, PolygonsOfAnyShape) {
  // A U of eight corners, clockwise from above.
  const ImportedScene u =
      read("v 0 0 0\nv 0 0 3\nv 1 0 3\nv 1 0 1\nv 2 0 1\nv 2 0 3\nv 3 0 3\nv 3 0 0\nf 1 2 3 4 5 6 7 8\n");
  ASSERT_EQ(u.scene.primitives.size(), 1u);
  const auto& polygon = std::get<Polygon>(u.scene.primitives[0].shape);
  EXPECT_NEAR(polygon.area, 7, 1e-12);
  EXPECT_EQ(polygon.vertices.size(), 8u);
  EXPECT_NEAR(polygon.normal.y, 1, 1e-12);
  EXPECT_EQ(u.report.surfaces.at("face"), 1u);
  EXPECT_EQ(u.scene.up, Vec3(0, 1, 0));
  // A bent quadrangle is two triangles.
  EXPECT_EQ(read("v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nf 1 2 3 4\n").scene.primitives.size(), 2u);
}

TEST(ObjReader, MoreThan255CornersInAFace) {
  std::string text, face = "f";
  for (int i = 0; i < 300; ++i) {
    const double angle = 2 * kPi * i / 300;
    text += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
    face += fmt::format(" {}", i - 300);
  }
  EXPECT_NEAR(totalArea(read(text + face + "\n").scene), kPi, 1e-3);
}

TEST(ObjReader, GroupsAreObjects) {
  const std::string triangle = "f 1 2 3\n";
  const ImportedScene imported =
      read("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + triangle + "g lone\n" + triangle + "o house \ng walls north/east\n" +
           triangle + "g walls\n" + triangle + "g\n" + triangle + "usemtl x\n" + triangle);
  std::vector<std::string> names;
  for (const Object& object : imported.scene.objects) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"house", "house/walls", "house/walls_north_east", "lone"}));
  EXPECT_EQ(imported.scene.primitives.size(), 6u);
  EXPECT_FALSE(imported.scene.primitives[0].object.valid());
  EXPECT_EQ(findObjects(imported.scene, "walls").size(), 1u);
  EXPECT_EQ(primitivesOf(imported.scene, findObjects(imported.scene, "house").at(0)).size(), 4u);
}

TEST(ObjReader, ReadsLinesAsPeopleWriteThem) {
  const ImportedScene imported = read(
      "# made by hand\r\nv +0 0. 0\r\nv\t1.0e0 .0 0 1\r\n  v 0 1 0 0.5 0.5 0.5\r\nvn 0 0 1\r\ns off\r\n"
      "f 1//1 \\\r\n 2//1 3//1\r\nl 1 2\r\nf -3 -2 -1");
  EXPECT_NEAR(totalArea(imported.scene), 1, 1e-12);
  EXPECT_EQ(imported.report.ignored.at("points or lines"), 1u);
  EXPECT_NEAR(totalArea(read("\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").scene), 0.5, 1e-12);
}

TEST(ObjReader, HolesBySeamsWoundEitherWay) {
  const std::string corners = "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\n";
  EXPECT_NEAR(totalArea(read(corners + "f 1 2 3 4 1 5 6 7 8 5\n").scene), 11, 1e-12);
  EXPECT_NEAR(totalArea(read(corners + "f 1 2 3 4 1 5 8 7 6 5\n").scene), 11, 1e-12);
  // Bent along the hole: triangles, not a polygon.
  const std::string bent = "v 0 0 0\nv 4 0 0\nv 4 3 1\nv 0 3 1\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\n";
  EXPECT_NEAR(totalArea(read(bent + "f 1 2 3 4 1 5 6 7 8 5\n").scene),
              totalArea(read(bent + "f 1 2 3 4 1 5 8 7 6 5\n").scene), 0.2);
}

TEST(ObjReader, CoordinatesKeepTheirDigits) {
  const ImportedScene imported = read("v 4512345.125 0 0\nv 4512346.125 0 0\nv 4512345.125 1 0\nf 1 2 3\n");
  EXPECT_NEAR(totalArea(imported.scene), 0.5, 1e-8);
}

TEST(ObjReader, SmoothNormalsMakeAMesh) {
  const ImportedScene imported = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 3 0 4\nvn 0 0 1\nf 1//1 2//2 3//2\n");
  const auto& mesh = std::get<Mesh>(imported.scene.primitives[0].shape);
  EXPECT_NEAR(mesh.normals[0].x, 0.6, 1e-12);
}

TEST_F(ObjFiles, DiffuseAndLobe) {
  const auto s = std::get<Opaque>(materialOf("Kd 0.5 0.4 0.3\nKs 0.2 0.2 0.2\nNs 98\n").surface);
  EXPECT_EQ(s.diffuse, Rgb(0.5f, 0.4f, 0.3f));
  EXPECT_EQ(s.specular.reflectance, Rgb(0.2f));
  EXPECT_NEAR(s.specular.roughness, std::sqrt(0.02), 1e-6);
  EXPECT_TRUE(imported_.report.warnings.empty());
  EXPECT_EQ(std::get<Opaque>(materialOf("Ks 0.2 0.2 0.2\nillum 1\n").surface).specular.reflectance, Rgb(0));
  const auto bright = std::get<Opaque>(materialOf("Kd 1 0.5 0\nKs 1 1 1\n").surface);
  EXPECT_LE(maxChannel(bright.diffuse + bright.specular.reflectance), 1 + 1e-6f);
  EXPECT_EQ(imported_.report.warnings.size(), 1u);
}

TEST_F(ObjFiles, DissolveIsCoverage) {
  const auto passes = [&](const std::string& mtl) {
    return straightTransmittance(materialOf("Kd 1 1 1\n" + mtl), 0.3);
  };
  EXPECT_EQ(passes("d 0.25\nNi 1.45\n"), Rgb(0.75f));
  EXPECT_EQ(passes("Tr 0.25\n"), Rgb(0.25f));
  EXPECT_EQ(passes("d 0.5\nTf 1 0.5 0.25\nillum 4\n"), Rgb(0.5f, 0.25f, 0.125f));
  EXPECT_EQ(passes("Tf 1 0.5 0.25\nillum 6\n"), Rgb(1, 0.5f, 0.25f));
  EXPECT_EQ(passes("Tf 1 1 1\nillum 2\nNi 1.5\n"), Rgb(0)) << "as exporters write of every wall";
  EXPECT_EQ(passes("d 0\n"), Rgb(1));
  const Material curtain = materialOf("Kd 0.8 0.8 0.8\nKe 4 4 4\nd 0.25\n");
  EXPECT_EQ(diffuseReflectance(curtain, false), Rgb(0.2f));
  EXPECT_EQ(curtain.emission->radiance, Rgb(1));
  EXPECT_TRUE(imported_.report.ignored.empty());
}

TEST_F(ObjFiles, HaloDissolvesAlikeAtEveryAngle) {
  for (const char* line : {"d -halo 0.25\n", "\td  -halo\t0.25\n", "Ni 1\nd -halo 0.25"}) {
    EXPECT_EQ(materialOf(line).coverage, 0.25f) << line;
    EXPECT_EQ(imported_.report.ignored.at("-halo of d (taken the same at every angle)"), 1u);
  }
  materialOf("# not d -halo 0.25\nd 0.5\n");
  EXPECT_TRUE(imported_.report.ignored.empty());
}

TEST_F(ObjFiles, GlassAndEmission) {
  const auto tinted = std::get<ThinGlass>(materialOf("Tf 0.9 0.8 0.7\nillum 7\nNi 1.5\n").surface);
  EXPECT_EQ(tinted.transmissivity, Rgb(0.9f, 0.8f, 0.7f));
  const Material lamp = materialOf("Kd 0 0 0\nKe 10 20 30\n");
  EXPECT_EQ(lamp.emission->radiance, Rgb(10, 20, 30));
  EXPECT_FALSE(lamp.emission->bothSides);
  EXPECT_EQ(imported_.scene.lights.size(), 1u);
}

TEST_F(ObjFiles, Textures) {
  std::string tga(18, '\0');
  tga[2] = 2, tga[12] = 1, tga[14] = 2, tga[16] = 24, tga[17] = 0x20;  // red above green
  write("wood grain.tga", tga + std::string("\x00\x00\xff\x00\xff\x00", 6));
  const auto s = std::get<Opaque>(materialOf("map_Kd wood grain.tga\n").surface);
  ASSERT_TRUE(s.diffuseTexture.valid());
  EXPECT_EQ(s.diffuse, Rgb(0.6f));  // tinyobjloader's grey where Kd is missing
  const auto& mesh = std::get<Mesh>(imported_.scene.primitives[0].shape);
  EXPECT_EQ(mesh.texcoords[2], Vec2(0, 0));  // vt 0 1, the upper end
  EXPECT_EQ(imported_.scene.textures[0].texels[0], Rgb(1, 0, 0));
  materialOf("map_Kd C:\\pictures\\wood.png\nmap_Bump x.png\n");
  EXPECT_EQ(imported_.report.ignored.at("textures not found or not readable"), 1u);
  EXPECT_EQ(imported_.report.ignored.at("material maps other than map_Kd"), 1u);
}

TEST_F(ObjFiles, MaterialFilesByAnyName) {
  write("my materials.mtl", "newmtl a\nKd 0.1 0.1 0.1\n");
  write("b.mtl", "newmtl b\nKd 0.2 0.2 0.2\n");
  const ImportedScene imported = read(
      "mtllib my materials.mtl\nmtllib missing.mtl b.mtl\nmtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
      "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\nusemtl c\nf 1 2 3\n",
      folder_.path());
  ASSERT_EQ(imported.scene.primitives.size(), 3u);
  EXPECT_EQ(std::get<Opaque>(imported.scene.materialOf(PrimitiveId(1)).surface).diffuse, Rgb(0.2f));
  EXPECT_EQ(std::get<Opaque>(imported.scene.materialOf(PrimitiveId(2)).surface).diffuse, Rgb(0.5f));
  EXPECT_EQ(imported.report.ignored.at("material files not found"), 2u);
  ASSERT_FALSE(imported.report.warnings.empty());
  EXPECT_NE(imported.report.warnings[0].find("'missing.mtl', 'gone.mtl'"), std::string::npos)
      << imported.report.warnings[0];
  EXPECT_NE(imported.report.warnings[0].find(folder_.path().string()), std::string::npos);
  EXPECT_EQ(imported.report.ignored.at("materials not defined (grey instead)"), 1u);
}

TEST_F(ObjFiles, ImpossibleMaterials) {
  EXPECT_THROW(materialOf("Ke -1 0 0\n"), InputError);
  EXPECT_THROW(materialOf("Ke 1e400 0 0\n"), InputError);
  EXPECT_THROW(materialOf("Kd 1 1 abc\n"), InputError);
  const auto s = std::get<Opaque>(materialOf("Kd 7 -3 0.5\nNs -5\n").surface);
  EXPECT_EQ(s.diffuse, Rgb(1, 0, 0.5f));
  ASSERT_EQ(imported_.report.warnings.size(), 1u);
  EXPECT_NE(imported_.report.warnings[0].find("1 colours above 1"), std::string::npos);
}

int errorLine(const std::string& text) {
  try {
    read(text);
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "scene.obj");
    EXPECT_FALSE(error.hint().empty());
    return error.line();
  }
  ADD_FAILURE() << "was read: " << text.substr(0, 200);
  return -1;
}

TEST(ObjReader, RefusesWithTheLine) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(errorLine(""), 0);
  EXPECT_EQ(errorLine(corners), 0);
  EXPECT_EQ(errorLine(std::string(100, '\0')), 0);
  EXPECT_EQ(errorLine(corners + "f 1 2 4\n"), 4);
  EXPECT_EQ(errorLine(corners + "\nf 1 2 0\n"), 5);
  EXPECT_EQ(errorLine(corners + "f 1 2 -4\n"), 4);
  EXPECT_EQ(errorLine(corners + "f 1 2 99999999999\n"), 4);
  EXPECT_EQ(errorLine(corners + "f 1/1 2/1 3/1\n"), 4);
  EXPECT_EQ(errorLine(corners + "f 1//1 2//1 3//1\n"), 4);
  EXPECT_EQ(errorLine(corners + "f 1 2 x\n"), 4);
  EXPECT_EQ(errorLine(corners + "f 1/1/1/1 2 3\n"), 4);
  EXPECT_EQ(errorLine("v 0 0\nf 1 1 1\n"), 1);
  EXPECT_EQ(errorLine("v 0 0 nan\nf 1 1 1\n"), 1);
  EXPECT_EQ(errorLine("v 0 0 1e300\nf 1 1 1\n"), 1);
  EXPECT_EQ(errorLine("v 0 0 zero\nf 1 1 1\n"), 1);
  EXPECT_EQ(errorLine("v 0 0 1e400\nf 1 1 1\n"), 1);
  EXPECT_EQ(errorLine("# \\\n\\\nv 0 0\n"), 0);  // all of it a comment: no faces
  EXPECT_EQ(errorLine("mtllib ../../etc/passwd\n" + corners + "f 1 2 3\n"), 1);
}

}  // namespace
}  // namespace deltalux
