// glTF files that lie: one InputError each, that names the place.
#include <gtest/gtest.h>

#include <deltalux/error.hpp>

#include "io/gltf.hpp"
#include "io/gltf_builder.hpp"

namespace deltalux {
using namespace io;

namespace {

using nlohmann::json;
using test::GltfBuilder;

InputError refusal(const std::string& bytes) {
  try {
    readGltf(bytes, "scene.gltf", "/nonexistent", {});
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "scene.gltf");
    EXPECT_FALSE(error.hint().empty()) << error.what();
    EXPECT_LT(std::string(error.what()).size(), 400u);
    return error;
  }
  ADD_FAILURE() << "was read: " << bytes.substr(0, 200);
  return InputError("", 0, "");
}

void expectRefused(const GltfBuilder& builder, const std::string& part) {
  const std::string message = refusal(builder.glb()).message();
  EXPECT_NE(message.find(part), std::string::npos) << message;
}

GltfBuilder triangle() {
  GltfBuilder g;
  const int positions = g.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  g.node({{"mesh", g.mesh({{"POSITION", positions}}, g.indices({0, 1, 2}))}});
  return g;
}

// The triangle with the member at `pointer` set to `value`.
GltfBuilder with(const char* pointer, const json& value) {
  GltfBuilder g = triangle();
  g.doc[json::json_pointer(pointer)] = value;
  return g;
}

TEST(GltfBadInput, TheTriangleItselfIsFine) {
  EXPECT_EQ(readGltf(triangle().glb(), "scene.gltf", "/", {}).scene.primitives.size(), 1u);
}

TEST(GltfBadInput, JsonWithALine) {
  EXPECT_EQ(refusal("{\n\"asset\": {\n").line(), 3);
  EXPECT_EQ(refusal("{\"asset\": {\"version\": \"2.0\"},\n \"x\": 1e999}").line(), 2);
  refusal("");
  refusal("[]");
  refusal("{}");
  refusal(std::string(100000, '['));
  refusal("{\"asset\": {\"version\": \"1.0\"}}");
  refusal("{\"asset\": {\"version\": \"2.0\", \"x\": \"\xff\"}}");
}

TEST(GltfBadInput, BinaryContainers) {
  const std::string good = triangle().glb();
  refusal(good.substr(0, 10));
  refusal(good.substr(0, good.size() - 4));
  std::string version = good, chunk = good, noJson = good;
  version[4] = 1;
  refusal(version);
  chunk[15] = 0x7f;
  refusal(chunk);
  noJson[16] = 'X';
  refusal(noJson);
}

TEST(GltfBadInput, BuffersThatLie) {
  expectRefused(with("/buffers", {{{"byteLength", 4000}}}), "/buffers/0");
  expectRefused(with("/buffers", {{{"byteLength", 4000}, {"uri", "data:application/octet-stream;base64,AAAA"}}}),
                "/buffers/0");
  expectRefused(with("/buffers", {{{"byteLength", 3}, {"uri", "data:application/octet-stream;base64,!!!!"}}}),
                "base64");
  expectRefused(with("/buffers", {{{"byteLength", -1}}}), "/buffers/0/byteLength");
  expectRefused(with("/buffers", {{{"byteLength", 42}, {"uri", "missing.bin"}}}), "not there");
  expectRefused(with("/buffers", {{{"byteLength", 42}, {"uri", "../../etc/passwd"}}}), "outside");
  expectRefused(with("/buffers", {{{"byteLength", 42}, {"uri", "%2e%2e/%2e%2e/etc/passwd"}}}), "outside");
  expectRefused(with("/buffers", {{{"byteLength", 42}, {"uri", "/etc/passwd"}}}), "absolute");
  expectRefused(with("/buffers", {{{"byteLength", 42}, {"uri", "http://example.org/a.bin"}}}), "beside");
  expectRefused(with("/bufferViews/0/byteLength", 1000), "/bufferViews/0");
  expectRefused(with("/bufferViews/0/byteOffset", 1000), "/bufferViews/0");
  expectRefused(with("/bufferViews/0/byteOffset", 18446744073709551610u), "/bufferViews/0/byteOffset");
  expectRefused(with("/bufferViews/0/buffer", 7), "/bufferViews/0/buffer");
  expectRefused(with("/bufferViews/0/byteStride", 2), "/bufferViews/0/byteStride");
}

TEST(GltfBadInput, AccessorsOutOfRange) {
  expectRefused(with("/accessors/0/count", 4), "/accessors/0 needs more bytes");
  expectRefused(with("/accessors/0/count", 2000000000), "/accessors/0 needs more bytes");
  expectRefused(with("/accessors/0/count", 0), "/accessors/0/count");
  expectRefused(with("/accessors/0/count", 3.5), "/accessors/0/count");
  expectRefused(with("/accessors/0/byteOffset", 8), "/accessors/0 needs more bytes");
  expectRefused(with("/accessors/0/componentType", 1), "componentType");
  expectRefused(with("/accessors/0/type", "VEC2"), "/accessors/0 is not of 3 components");
  expectRefused(with("/accessors/0/type", "VEC9"), "VEC9");
  expectRefused(with("/accessors/0/bufferView", 9), "/accessors/0/bufferView");
  expectRefused(with("/accessors/1/componentType", 5126), "/accessors/1");
  expectRefused(
      with("/accessors/0/sparse",
           {{"count", 1}, {"indices", {{"bufferView", 1}, {"componentType", 5123}}}, {"values", {{"bufferView", 1}}}}),
      "/accessors/0");
  GltfBuilder compressed = triangle();
  compressed.doc["accessors"][0].erase("bufferView");
  expectRefused(compressed, "no data");
}

TEST(GltfBadInput, Geometry) {
  GltfBuilder g = triangle();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  g.bytes.replace(4, 4, reinterpret_cast<const char*>(&nan), 4);
  expectRefused(g, "/accessors/0 holds numbers that are not finite");
  GltfBuilder index = triangle();
  index.bytes[36] = 3;
  expectRefused(index, "/meshes/0/primitives/0 refers to vertex 3 of 3");
  expectRefused(with("/meshes/0/primitives/0/indices", 5), "/meshes/0/primitives/0/indices");
  expectRefused(with("/meshes/0/primitives/0/mode", 7), "/meshes/0/primitives/0/mode");
  expectRefused(with("/meshes/0/primitives/0/material", 0), "/meshes/0/primitives/0/material");
  expectRefused(with("/meshes/0/primitives/0/attributes", json::object()), "POSITION");
  expectRefused(with("/meshes/0/primitives/0/attributes/NORMAL", 1), "/accessors/1");
  expectRefused(with("/meshes/0/primitives", json::object()), "/meshes/0/primitives");
  expectRefused(with("/nodes/0/translation", {1e16, 1, 1}), "/nodes/0/translation/0");
  GltfBuilder far = triangle();
  far.node({{"scale", {1e10, 1, 1}}, {"children", {2}}});
  far.node({{"scale", {1e10, 1, 1}}, {"mesh", 0}}, false);
  expectRefused(far, "/nodes/2 has coordinates beyond");
}

TEST(GltfBadInput, NodesThatAreNoTree) {
  expectRefused(with("/nodes/0/children", {0}), "/nodes/0");
  expectRefused(with("/scenes/0/nodes", {0, 0}), "/nodes/0");
  expectRefused(with("/scenes/0/nodes", {4}), "/scenes/0/nodes/0");
  expectRefused(with("/scene", 3), "/scene");
  expectRefused(with("/nodes/0/matrix", {1, 0, 0}), "/nodes/0/matrix");
  expectRefused(with("/nodes/0/mesh", "0"), "/nodes/0/mesh");
  GltfBuilder loop = triangle();
  loop.node({{"children", {2}}});
  loop.node({{"children", {1}}}, false);
  expectRefused(loop, "ancestor");
  GltfBuilder deep = triangle();
  for (int i = 1; i < 300; ++i) deep.node({{"children", {i + 1}}}, i == 1);
  deep.node(json::object(), false);
  expectRefused(deep, "200");
}

TEST(GltfBadInput, ExtensionsThatAreNeededButNotRead) {
  for (const char* extension : {"KHR_draco_mesh_compression", "KHR_meshopt_compression", "KHR_texture_basisu"}) {
    const InputError error = refusal(with("/extensionsRequired", {extension}).glb());
    EXPECT_NE(error.message().find(extension), std::string::npos);
    EXPECT_NE(error.hint().find("without compression"), std::string::npos);
  }
  expectRefused(with("/extensionsRequired", {"ACME_unheard_of"}), "ACME_unheard_of");
}

// Files that name no extension as required, and hold nothing else to read.
TEST(GltfBadInput, CompressionThatIsNotSaidToBeRequired) {
  for (const char* const extension : {"KHR_draco_mesh_compression", "ACME_points"}) {
    GltfBuilder g = triangle();
    g.doc["meshes"][0]["primitives"][0]["extensions"] = {{extension, {{"bufferView", 0}}}};
    EXPECT_EQ(readGltf(g.glb(), "scene.gltf", "/", {}).scene.primitives.size(), 1u) << "the plain form is there too";
    for (json& accessor : g.doc["accessors"]) accessor.erase("bufferView");
    const InputError error = refusal(g.glb());
    EXPECT_NE(error.message().find(extension), std::string::npos) << error.message();
    EXPECT_NE(error.message().find("/meshes/0/primitives/0"), std::string::npos) << error.message();
    EXPECT_NE(error.hint().find("without compression"), std::string::npos);
  }
  for (const char* const extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
    GltfBuilder g = triangle();
    g.doc["bufferViews"][1]["extensions"] = {{extension, {{"buffer", 0}}}};
    EXPECT_EQ(readGltf(g.glb(), "scene.gltf", "/", {}).scene.primitives.size(), 1u) << "the plain form is there too";
    g.doc["buffers"] = {{{"byteLength", g.bytes.size()}},
                        {{"byteLength", 100}, {"extensions", {{extension, {{"fallback", true}}}}}}};
    g.doc["bufferViews"][1]["buffer"] = 1;
    const InputError error = refusal(g.glb());
    EXPECT_NE(error.message().find(extension), std::string::npos) << error.message();
    EXPECT_NE(error.message().find("/bufferViews/1"), std::string::npos) << error.message();
  }
  GltfBuilder g = triangle();
  g.doc["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  g.doc["images"] = {{{"bufferView", 0}, {"mimeType", "image/webp"}}};
  g.material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
  expectRefused(g, "EXT_texture_webp");
}

TEST(GltfBadInput, LightsCamerasMaterials) {
  expectRefused(with("/extensions", {{"KHR_lights_punctual", {{"lights", {{{"type", "laser"}}}}}}}), "lights/0");
  expectRefused(with("/extensions", {{"EXT_lights_ies", {{"lights", {{{"uri", "x"}, {"bufferView", 0}}}}}}}),
                "lights/0");
  expectRefused(with("/nodes/0/extensions", {{"KHR_lights_punctual", {{"light", 0}}}}), "/nodes/0/extensions");
  expectRefused(with("/cameras", {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 1}}}}}), "yfov");
  expectRefused(with("/materials", {{{"emissiveFactor", {-1, 0, 0}}}}), "/materials/0/emissiveFactor/0");
  expectRefused(with("/materials", {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}),
                "baseColorTexture/index");
  GltfBuilder ies = triangle();
  ies.doc["extensions"]["EXT_lights_ies"]["lights"] = {{{"bufferView", 0}}};
  try {
    readGltf(ies.glb(), "scene.gltf", "/nonexistent", {});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "scene.gltf/extensions/EXT_lights_ies/lights/0");
  }
}

}  // namespace
}  // namespace deltalux
