// What glTF files have beyond plain meshes: colours of vertices, instances, compressed buffers.
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <deltalux/error.hpp>
#include <deltalux/io.hpp>

#include "io/gltf.hpp"
#include "io/gltf_builder.hpp"
#include "scene/texture_tint.hpp"

namespace deltalux {
namespace {

using test::GltfBuilder;

ImportedScene read(const GltfBuilder& b) { return io::readGltf(b.glb(), "test.glb", ".", {}); }

Rgb diffuseOf(const Scene& scene, std::size_t primitive) {
  return std::get<Opaque>(scene.materialOf(PrimitiveId(primitive)).surface).diffuse;
}

/// A square with colours at its corners.
GltfBuilder colouredQuad(const std::vector<float>& colours, int material = -1) {
  GltfBuilder b;
  if (material >= 0)
    b.material(
        {{"name", "paint"}, {"pbrMetallicRoughness", {{"baseColorFactor", {0.5, 1, 1, 1}}, {"metallicFactor", 0}}}});
  const int positions = b.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}), colour = b.vec3(colours);
  b.mesh({{"POSITION", positions}, {"COLOR_0", colour}}, b.indices({0, 1, 2, 0, 2, 3}), material);
  b.node({{"mesh", 0}, {"name", "square"}});
  return b;
}

TEST(GltfVertexColours, OneColourIsTheMaterials) {
  const ImportedScene imported = read(colouredQuad({1, .5, .25, 1, .5, .25, 1, .5, .25, 1, .5, .25}, 0));
  const Scene& scene = imported.scene;
  ASSERT_EQ(scene.primitives.size(), 1u);
  EXPECT_TRUE(std::holds_alternative<Polygon>(scene.primitives[0].shape));  // flat faces stay flat
  EXPECT_EQ(scene.materialOf(PrimitiveId(0)).name, "paint");
  const Rgb plain = std::get<Opaque>(scene.materials[0].surface).diffuse;
  EXPECT_NEAR(glm::length(diffuseOf(scene, 0) - plain * Rgb(1, 0.5f, 0.25f)), 0, 1e-6);
  EXPECT_TRUE(imported.report.ignored.empty());
  EXPECT_NO_THROW(validate(scene));
}

TEST(GltfVertexColours, ColoursOfFacesPartTheMesh) {
  GltfBuilder b;
  const int positions = b.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0});
  const int colours = b.vec3({1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  b.mesh({{"POSITION", positions}, {"COLOR_0", colours}});
  b.node({{"mesh", 0}}), b.node({{"mesh", 0}, {"translation", {2, 0, 0}}});
  const Scene scene = read(b).scene;
  ASSERT_EQ(scene.primitives.size(), 4u);
  EXPECT_EQ(scene.materials.size(), 3u);  // the default one, and one of each colour
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(area(scene.primitives[i].shape), 0.5, 1e-9);
  EXPECT_EQ(scene.primitives[0].material, scene.primitives[2].material);
  EXPECT_GT(std::abs(diffuseOf(scene, 0).r - diffuseOf(scene, 1).r), 0.1);
}

TEST(GltfVertexColours, ColoursRunBetweenCorners) {
  const Scene scene = read(colouredQuad({1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1})).scene;
  ASSERT_EQ(scene.primitives.size(), 1u);
  ASSERT_EQ(scene.textures.size(), 1u);
  EXPECT_NO_THROW(validate(scene));
  const Mesh& mesh = std::get<Mesh>(scene.primitives[0].shape);
  ASSERT_EQ(mesh.triangles.size(), 2u);
  const auto tint = [&](std::uint32_t triangle, double x, double y) {
    return scene::textureTint(scene, PrimitiveId(0), triangle, {x, y, 0});
  };
  EXPECT_NEAR(glm::length(tint(0, 0, 0) - Rgb(1, 0, 0)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(0, 1, 0) - Rgb(0, 1, 0)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(0, 1, 1) - Rgb(0, 0, 1)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(1, 0, 1) - Rgb(1, 1, 1)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(0, 0.5, 0.5) - Rgb(0.5f, 0, 0.5f)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(0, 2. / 3, 1. / 3) - Rgb(1 / 3.f)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(1, 0.5, 0.5) - Rgb(0.5f, 0, 0.5f)), 0, 1e-5);
  EXPECT_NEAR(glm::length(tint(1, 1. / 3, 2. / 3) - Rgb(2 / 3.f, 1 / 3.f, 2 / 3.f)), 0, 1e-5);
}

TEST(GltfVertexColours, BytesAndAlphaAreRead) {
  GltfBuilder b;
  const int positions = b.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0});
  const int colours =
      b.accessor(b.view(std::vector<std::uint8_t>{255, 51, 0, 9, 255, 51, 0, 9, 255, 51, 0, 9}), 5121, 3, "VEC4");
  b.doc["accessors"][static_cast<std::size_t>(colours)]["normalized"] = true;
  b.mesh({{"POSITION", positions}, {"COLOR_0", colours}});
  b.node({{"mesh", 0}});
  const Scene scene = read(b).scene;
  const Rgb d = diffuseOf(scene, 0);
  EXPECT_NEAR(d.g / d.r, 0.2, 1e-5);
  EXPECT_EQ(d.b, 0);
  b.doc["accessors"][static_cast<std::size_t>(colours)]["count"] = 2;
  EXPECT_THROW(read(b), InputError);
}

TEST(GltfInstances, AMeshStandsManyTimes) {
  GltfBuilder b;
  b.quad();
  const int places = b.vec3({0, 0, 0, 3, 0, 0, 0, 5, 0}), sizes = b.vec3({1, 1, 1, 2, 2, 2, 1, 1, 1});
  const int turns =
      b.accessor(b.view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.70710678f, 0.70710678f}), 5126, 3, "VEC4");
  b.doc["extensionsUsed"] = b.doc["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  b.node({{"mesh", 0},
          {"name", "trees"},
          {"translation", {0, 0, 7}},
          {"extensions",
           {{"EXT_mesh_gpu_instancing",
             {{"attributes", {{"TRANSLATION", places}, {"SCALE", sizes}, {"ROTATION", turns}}}}}}}});
  b.node({{"name", "last"}});
  const ImportedScene imported = read(b);
  const Scene& scene = imported.scene;
  EXPECT_TRUE(imported.report.ignored.empty());
  ASSERT_EQ(scene.primitives.size(), 3u);
  EXPECT_NO_THROW(validate(scene));
  EXPECT_NEAR(area(scene.primitives[1].shape), 4, 1e-6);
  const Box second = bounds(scene.primitives[1].shape), third = bounds(scene.primitives[2].shape);
  EXPECT_NEAR(glm::length(second.lower - Vec3(3, 0, 7)), 0, 1e-6);
  EXPECT_NEAR(glm::length(third.lower - Vec3(-1, 5, 7)), 0, 1e-6);
  EXPECT_EQ(scene[scene.primitives[2].object].name, "trees/2");
  EXPECT_EQ(primitivesOf(scene, findObjects(scene, "trees").at(0)).size(), 3u);
  b.doc["accessors"][static_cast<std::size_t>(turns)]["count"] = 2;
  EXPECT_THROW(read(b), InputError);
  b.doc["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = 99;
  EXPECT_THROW(read(b), InputError);
}

/// A square whose buffers are there packed alone.
struct Packed : GltfBuilder {
  std::size_t unpacked = 0;

  int pack(const std::string& packed, std::size_t count, std::size_t stride, const char* mode, const char* filter) {
    while (bytes.size() % 4) bytes += '\0';
    doc["bufferViews"].push_back({{"buffer", 1},
                                  {"byteOffset", unpacked},
                                  {"byteLength", count * stride},
                                  {"extensions",
                                   {{"EXT_meshopt_compression",
                                     {{"buffer", 0},
                                      {"byteOffset", bytes.size()},
                                      {"byteLength", packed.size()},
                                      {"byteStride", stride},
                                      {"count", count},
                                      {"mode", mode},
                                      {"filter", filter}}}}}});
    bytes += packed, unpacked += count * stride;
    return static_cast<int>(doc["bufferViews"].size()) - 1;
  }
  int vertices(const void* values, std::size_t count, std::size_t stride, const char* filter = "NONE") {
    std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
    packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), values,
                                             count, stride));
    return pack(packed, count, stride, "ATTRIBUTES", filter);
  }
  int triangles(const std::vector<unsigned int>& indices) {
    std::string packed(meshopt_encodeIndexBufferBound(indices.size(), 64), '\0');
    packed.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                            indices.data(), indices.size()));
    return pack(packed, indices.size(), 4, "TRIANGLES", "NONE");
  }
  int sequence(const std::vector<unsigned int>& indices) {
    std::string packed(meshopt_encodeIndexSequenceBound(indices.size(), 64), '\0');
    packed.resize(meshopt_encodeIndexSequence(reinterpret_cast<unsigned char*>(packed.data()), packed.size(),
                                              indices.data(), indices.size()));
    return pack(packed, indices.size(), 2, "INDICES", "NONE");
  }
  void finish() {
    doc["extensionsUsed"] = doc["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    doc["buffers"] = {{{"byteLength", bytes.size()}},
                      {{"byteLength", unpacked}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  }
};

TEST(GltfMeshopt, PackedBuffersAreRead) {
  for (const bool strip : {false, true}) {
    Packed b;
    const std::vector<float> corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
    const int positions = b.accessor(b.vertices(corners.data(), 4, 12), 5126, 4, "VEC3");
    // Normals in octahedra of bytes: straight up.
    const std::vector<std::int8_t> up{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
    const int normals = b.accessor(b.vertices(up.data(), 4, 4, "OCTAHEDRAL"), 5120, 4, "VEC3");
    b.doc["accessors"][static_cast<std::size_t>(normals)]["normalized"] = true;
    b.doc["bufferViews"][1]["byteStride"] = 4;
    const int indices = strip ? b.accessor(b.sequence({0, 1, 3, 2}), 5123, 4, "SCALAR")
                              : b.accessor(b.triangles({0, 1, 2, 0, 2, 3}), 5125, 6, "SCALAR");
    b.mesh({{"POSITION", positions}, {"NORMAL", normals}}, indices, -1, strip ? 5 : 4);
    b.node({{"mesh", 0}});
    b.finish();
    const ImportedScene imported = read(b);
    ASSERT_EQ(imported.scene.primitives.size(), 1u) << strip;
    EXPECT_NEAR(area(imported.scene.primitives[0].shape), 1, 1e-9) << strip;
    EXPECT_TRUE(imported.report.ignored.empty()) << strip;
  }
}

TEST(GltfMeshopt, WrongPackingsAreInputErrors) {
  Packed good;
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
  const int positions = good.accessor(good.vertices(corners.data(), 4, 12), 5126, 4, "VEC3");
  good.mesh({{"POSITION", positions}});
  good.node({{"mesh", 0}});
  good.finish();
  EXPECT_NO_THROW(read(good));
  const std::vector<std::pair<const char*, nlohmann::json>> wrong{
      {"mode", "SOMETHING"}, {"mode", "TRIANGLES"}, {"filter", "OCTAHEDRAL"},
      {"filter", "BLUR"},    {"byteStride", 10},    {"byteStride", 300},
      {"count", 2000000000}, {"count", 3000},       {"byteLength", 5},
      {"byteOffset", 4000},  {"buffer", 7},         {"buffer", 1},
      {"mode", 3},           {"count", -1}};
  for (const auto& [key, value] : wrong) {
    Packed b = good;
    b.doc["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    EXPECT_THROW(read(b), InputError) << key << value;
  }
  Packed b = good;
  b.doc["bufferViews"][0].erase("extensions");
  EXPECT_THROW(read(b), InputError);
}

}  // namespace
}  // namespace deltalux
