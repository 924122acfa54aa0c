#pragma once
// Small glTF documents made in tests.
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace deltalux::test {

struct GltfBuilder {
  nlohmann::json doc = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  std::string bytes;

  template <class T>
  int view(const std::vector<T>& values) {
    while (bytes.size() % 4) bytes += '\0';
    doc["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    return static_cast<int>(doc["bufferViews"].size()) - 1;
  }
  int accessor(int view, int componentType, std::size_t count, const char* type) {
    doc["accessors"].push_back(
        {{"bufferView", view}, {"componentType", componentType}, {"count", count}, {"type", type}});
    return static_cast<int>(doc["accessors"].size()) - 1;
  }
  int vec3(const std::vector<float>& values) { return accessor(view(values), 5126, values.size() / 3, "VEC3"); }
  int vec2(const std::vector<float>& values) { return accessor(view(values), 5126, values.size() / 2, "VEC2"); }
  int indices(const std::vector<std::uint16_t>& values) {
    return accessor(view(values), 5123, values.size(), "SCALAR");
  }

  int mesh(nlohmann::json attributes, int indexAccessor = -1, int material = -1, int mode = 4) {
    nlohmann::json primitive = {{"attributes", std::move(attributes)}, {"mode", mode}};
    if (indexAccessor >= 0) primitive["indices"] = indexAccessor;
    if (material >= 0) primitive["material"] = material;
    doc["meshes"].push_back({{"primitives", {std::move(primitive)}}});
    return static_cast<int>(doc["meshes"].size()) - 1;
  }
  /// A unit square in z = 0 facing +z.
  int quad(int material = -1) {
    return mesh({{"POSITION", vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0})}}, indices({0, 1, 2, 0, 2, 3}), material);
  }
  int material(nlohmann::json value) {
    doc["materials"].push_back(std::move(value));
    return static_cast<int>(doc["materials"].size()) - 1;
  }
  int node(nlohmann::json value, bool root = true) {
    doc["nodes"].push_back(std::move(value));
    const int index = static_cast<int>(doc["nodes"].size()) - 1;
    if (root) doc["scenes"][0]["nodes"].push_back(index);
    return index;
  }

  std::string glb() const {
    nlohmann::json complete = doc;
    if (!complete.contains("buffers") && !bytes.empty()) complete["buffers"] = {{{"byteLength", bytes.size()}}};
    std::string json = complete.dump(), binary = bytes;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string file = "glTF" + word(2) + word(12 + 8 + json.size() + (binary.empty() ? 0 : 8 + binary.size()));
    file += word(json.size()) + "JSON" + json;
    if (!binary.empty()) file += word(binary.size()) + std::string("BIN\0", 4) + binary;
    return file;
  }

  static std::string word(std::size_t value) {
    const auto word = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&word), 4);
  }
};

}  // namespace deltalux::test
