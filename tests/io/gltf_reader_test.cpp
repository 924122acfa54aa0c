#include "io/gltf.hpp"

#include <gtest/gtest.h>

#include <deltalux/error.hpp>

#include "io/gltf_builder.hpp"
#include "support/shared.hpp"

namespace deltalux {
using namespace io;

namespace {

using test::GltfBuilder;

ImportedScene read(const std::string& bytes, const ImportSettings& settings = {}) {
  ImportedScene imported = readGltf(bytes, "scene.glb", "/nonexistent", settings);
  validate(imported.scene);
  return imported;
}
ImportedScene read(const GltfBuilder& builder, const ImportSettings& settings = {}) {
  return read(builder.glb(), settings);
}

const Polygon& polygonOf(const ImportedScene& imported, std::size_t primitive) {
  return std::get<Polygon>(imported.scene.primitives.at(primitive).shape);
}

void expectNear(const Vec3& a, const Vec3& b, double tolerance = 1e-6) {
  EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

TEST(GltfReader, FurnaceReflectsAndEmits) {
  DELTALUX_SHARED_OR_SKIP(shared);
  const ImportedScene furnace = loadGltf(shared / "reference/furnace.gltf", {});
  validate(furnace.scene);
  ASSERT_EQ(furnace.scene.primitives.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const Polygon& wall = polygonOf(furnace, i);
    EXPECT_NEAR(wall.area, 1, 1e-9);
    EXPECT_GT(glm::dot(wall.normal, Vec3(0.5) - wall.vertices[0]), 0);  // faces inside
  }
  const Material& material = furnace.scene.materialOf(PrimitiveId(0));
  const auto& surface = std::get<Opaque>(material.surface);
  EXPECT_EQ(surface.diffuse, Rgb(0.5f));
  EXPECT_EQ(surface.specular.reflectance, Rgb(0.0f));
  ASSERT_TRUE(material.emission);
  EXPECT_FLOAT_EQ(material.emission->radiance.g, 1 / 179.0f);
  EXPECT_FALSE(material.emission->bothSides);
  EXPECT_EQ(furnace.scene.lights.size(), 6u);
  EXPECT_EQ(furnace.scene.objects[0].name, "furnace");
  EXPECT_TRUE(furnace.report.warnings.empty());
}

TEST(GltfReader, TransformsAndNamesFollowTheTree) {
  GltfBuilder g;
  const int quad = g.quad();
  const int inner = g.node(
      {{"name", "in/ner"}, {"mesh", quad}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}}, false);
  const int twin = g.node({{"name", "in/ner"}, {"mesh", quad}}, false);
  const int unnamed = g.node({{"scale", {2, 3, 1}}}, false);
  g.node({{"name", "outer"},
          {"translation", {0, 0, 10}},
          {"rotation", {0, 0.70710678118654752, 0, 0.70710678118654752}},  // 90 degrees about y: z -> x, x -> -z
          {"scale", {2, 2, 2}},
          {"children", {inner, twin, unnamed}}});
  const ImportedScene imported = read(g);
  ASSERT_EQ(imported.scene.primitives.size(), 2u);
  std::vector<std::string> names;
  for (const Object& object : imported.scene.objects) names.push_back(object.name);
  EXPECT_EQ(names, (std::vector<std::string>{"outer", "outer/in_ner", "outer/in_ner#2", "outer/node2"}));
  EXPECT_EQ(imported.scene.objects[1].parent, ObjectId(0));
  EXPECT_FALSE(imported.scene.objects[0].parent.valid());
  EXPECT_EQ(imported.scene.primitives[1].object, ObjectId(2));
  EXPECT_EQ(imported.scene.up, Vec3(0, 1, 0));
  // The inner square spans (5,0)-(4,1) in its parent's xy; its corner (1,0,0) goes to (5,1,0), then to (0,2,0).
  const Polygon& square = polygonOf(imported, 0);
  EXPECT_NEAR(square.area, 4, 1e-6);
  expectNear(square.normal, {1, 0, 0});
  Box box;
  for (const Vec3& v : square.vertices) box.extend(v);
  expectNear(box.lower, {0, 0, 0});
  expectNear(box.upper, {0, 2, 2});
}

TEST(GltfReader, MirroringKeepsTheFront) {
  GltfBuilder g;
  g.node({{"mesh", g.quad()}, {"scale", {-1, 1, 1}}});
  const ImportedScene imported = read(g);
  expectNear(polygonOf(imported, 0).normal, {0, 0, 1});
  EXPECT_LT(polygonOf(imported, 0).vertices[2].x, 0.5);
}

TEST(GltfReader, StripsFansAndPoints) {
  GltfBuilder g;
  const int positions = g.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0});
  g.node({{"mesh", g.mesh({{"POSITION", positions}}, -1, -1, 5)}});
  g.node({{"mesh", g.mesh({{"POSITION", positions}}, g.indices({0, 1, 3, 2}), -1, 6)}});
  g.node({{"mesh", g.mesh({{"POSITION", positions}}, -1, -1, 0)}});
  const ImportedScene imported = read(g);
  ASSERT_EQ(imported.scene.primitives.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(polygonOf(imported, i).area, 1, 1e-6);
    expectNear(polygonOf(imported, i).normal, {0, 0, 1});
  }
  EXPECT_EQ(imported.report.ignored.at("points or lines"), 1u);
  EXPECT_EQ(imported.report.surfaces.at("mesh primitive"), 2u);
  ASSERT_EQ(imported.report.warnings.size(), 1u);
  EXPECT_EQ(imported.report.warnings[0], "ignored: 1 points or lines");
}

TEST(GltfReader, SmoothMeshesKeepTheirNormals) {
  GltfBuilder g;
  const int positions = g.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int normals = g.vec3({0.6f, 0, 0.8f, 0, 0, 1, 0, 0, 1});
  g.node({{"mesh", g.mesh({{"POSITION", positions}, {"NORMAL", normals}})}, {"scale", {2, 1, 1}}});
  const ImportedScene imported = read(g);
  const auto& mesh = std::get<Mesh>(imported.scene.primitives[0].shape);
  expectNear(mesh.normals[0], glm::normalize(Vec3(0.3, 0, 0.8)));
  expectNear(mesh.positions[1], {2, 0, 0});
}

TEST(GltfReader, SparseNormalizedAndInterleavedAccessors) {
  GltfBuilder g;
  // Positions as normalized bytes every eight bytes [KHR_mesh_quantization], the third corner moved by a sparse value.
  const int view = g.view(std::vector<std::int8_t>{0, 0, 0, 9, 9, 9, 9, 9, 127, 0, 0, 9, 9, 9, 9, 9, 0, 127, 0, 9});
  g.doc["bufferViews"][view]["byteStride"] = 8;
  const int positions = g.accessor(view, 5120, 3, "VEC3");
  g.doc["accessors"][positions]["normalized"] = true;
  g.doc["accessors"][positions]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", g.view(std::vector<std::uint8_t>{2})}, {"componentType", 5121}}},
      {"values", {{"bufferView", g.view(std::vector<std::int8_t>{0, -128, 0})}}}};
  g.doc["extensionsRequired"] = {"KHR_mesh_quantization"};
  g.node({{"mesh", g.mesh({{"POSITION", positions}})}});
  const Polygon triangle = polygonOf(read(g), 0);
  EXPECT_NEAR(triangle.area, 0.5, 1e-12);
  expectNear(triangle.vertices[2], {0, -1, 0});
  expectNear(triangle.normal, {0, 0, -1});
}

TEST(GltfReader, CamerasLookAlongMinusZ) {
  GltfBuilder g;
  g.doc["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 1.0}, {"aspectRatio", 2.0}, {"znear", 0.1}}}},
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}}};
  g.node({{"name", "eye"}, {"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {5, 5, 5}}});
  g.node({{"name", "plan"}, {"camera", 1}, {"rotation", {-0.70710678118654752, 0, 0, 0.70710678118654752}}});
  const ImportedScene imported = read(g);
  ASSERT_EQ(imported.scene.views.size(), 2u);
  const View& eye = imported.scene.views[0];
  EXPECT_EQ(eye.name, "eye");
  expectNear(eye.position, {1, 2, 3});
  expectNear(glm::normalize(eye.direction), {0, 0, -1});
  expectNear(eye.up, {0, 1, 0});
  EXPECT_NEAR(eye.vertical, 180 / kPi, 1e-9);
  EXPECT_NEAR(std::tan(eye.horizontal * kPi / 360), 2 * std::tan(0.5), 1e-12);
  const View& plan = imported.scene.views[1];
  EXPECT_EQ(plan.kind, View::Kind::Parallel);
  EXPECT_EQ(plan.horizontal, 6);
  EXPECT_EQ(plan.vertical, 4);
  expectNear(glm::normalize(plan.direction), {0, -1, 0});
}

TEST(GltfReader, ReadsTheDefaultScene) {
  GltfBuilder g;
  const int quad = g.quad();
  g.node({{"name", "first"}, {"mesh", quad}});
  const int second = g.node({{"name", "second"}, {"mesh", quad}}, false);
  g.doc["scenes"].push_back({{"nodes", {second}}});
  g.doc["scene"] = 1;
  const ImportedScene imported = read(g);
  ASSERT_EQ(imported.scene.objects.size(), 1u);
  EXPECT_EQ(imported.scene.objects[0].name, "second");
  EXPECT_EQ(imported.report.ignored.at("other scenes"), 1u);
  g.doc.erase("scene");
  EXPECT_EQ(read(g).scene.objects[0].name, "first");
  g.doc.erase("scenes");
  EXPECT_EQ(read(g).scene.objects.size(), 2u);
}

TEST(GltfReader, FilesBesideTheScene) {
  const std::filesystem::path assets = test::sourceFolder() / "tests/assets";
  const ImportedScene imported = loadGltf(assets / "triangle.gltf", {});
  validate(imported.scene);
  EXPECT_NEAR(polygonOf(imported, 0).area, 0.5, 1e-6);
  EXPECT_THROW(loadGltf(assets / "nothing.gltf", {}), InputError);
}

}  // namespace
}  // namespace deltalux
