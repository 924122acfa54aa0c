#include "io/gltf/document.hpp"

#include <algorithm>
#include <cstring>
#include <deltalux/error.hpp>

#include "io/gltf/check.hpp"
#include "io/gltf/unpack.hpp"
#include "io/import_file.hpp"
#include "io/json_text.hpp"

namespace deltalux::io {

namespace {

using nlohmann::json;
constexpr const char* kExportAgain = "export the scene again";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;  // [glTF 2.0, 4.4.3] [layout]

struct Container {
  std::string_view json;
  std::string_view binary;
  bool isBinary = false;
};

std::uint32_t wordAt(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, 4);
  return word;
}

Container openBinary(std::string_view bytes, const std::string& name) {
  const auto fail = [&](const std::string& message) { return InputError(name, 0, message, kExportAgain); };
  if (bytes.size() < 20) throw fail("the file is truncated");
  if (wordAt(bytes, 4) != 2) throw fail("is binary glTF of version " + std::to_string(wordAt(bytes, 4)) + ", not 2");
  if (wordAt(bytes, 8) > bytes.size()) {
    throw fail("says it has " + std::to_string(wordAt(bytes, 8)) + " bytes, but has " + std::to_string(bytes.size()) +
               ": it is truncated");
  }
  bytes = bytes.substr(0, wordAt(bytes, 8));
  Container container{{}, {}, true};
  for (std::size_t offset = 12; offset + 8 <= bytes.size();) {
    const std::size_t length = wordAt(bytes, offset);
    const std::uint32_t type = wordAt(bytes, offset + 4);
    if (length > bytes.size() - offset - 8) throw fail("a chunk of it is longer than the file");
    const std::string_view content = bytes.substr(offset + 8, length);
    if (type == kJsonChunk && container.json.empty()) container.json = content;
    if (type == kBinChunk && container.binary.empty()) container.binary = content;
    offset += 8 + length;
  }
  if (container.json.empty()) throw fail("has no JSON chunk");
  return container;
}

Container openContainer(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, 4) == "glTF") return openBinary(bytes, name);
  return {bytes, {}, false};
}

std::string bytesOfBuffer(const json& buffer, std::size_t index, const GltfDocument& document,
                          const Container& container) {
  const std::string where = "/buffers/" + std::to_string(index);
  const auto length = buffer.at("byteLength").get<std::size_t>();
  std::string bytes;
  if (isFallback(buffer)) return bytes;
  if (buffer.contains("uri")) {
    bytes = bytesOfUri(document.name, document.folder, buffer.at("uri").get<std::string>(), where);
  } else if (container.isBinary && index == 0) {
    bytes = container.binary;
  } else {
    throw InputError(document.name, 0, where + " has no uri", "export the scene again without compression");
  }
  if (bytes.size() < length) {
    throw InputError(
        document.name, 0,
        where + " says it has " + std::to_string(length) + " bytes, but has " + std::to_string(bytes.size()),
        kExportAgain);
  }
  bytes.resize(length);
  return bytes;
}

GltfImage imageOf(const json& image) {
  GltfImage source;
  source.uri = image.value("uri", "");
  source.bufferView = image.value("bufferView", -1);
  return source;
}

}  // namespace

std::string bytesOfUri(const std::string& name, const std::filesystem::path& folder, const std::string& uri,
                       const std::string& where) {
  if (!uri.starts_with("data:")) {
    const std::filesystem::path file = resolveReference(uri, folder, name, 0, true);
    if (!std::filesystem::is_regular_file(file)) {
      throw InputError(name, 0, where + " refers to " + file.string() + ", which is not there",
                       "put the file back beside the scene");
    }
    return readInputFile(file);
  }
  const std::size_t comma = uri.find(',');
  std::vector<unsigned char> bytes;
  std::string mime;
  if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64") ||
      !tinygltf::DecodeDataURI(&bytes, mime, "data:application/octet-stream;base64" + uri.substr(comma), 0, false)) {
    throw InputError(name, 0, where + " has a data uri that is not base64", kExportAgain);
  }
  return std::string(bytes.begin(), bytes.end());
}

GltfDocument openGltf(std::string_view bytes, const std::string& name, const std::filesystem::path& folder) {
  GltfDocument document;
  document.name = name;
  document.folder = folder;
  const Container container = openContainer(bytes, name);
  json tree = parseJson(container.json, name, kExportAgain);
  checkGltf(tree, name);

  const auto entries = [&](const char* key) -> json {
    return tree.contains(key) ? std::move(tree[key]) : json::array();
  };
  if (tree.contains("buffers"))
    for (std::size_t i = 0; i < tree["buffers"].size(); ++i)
      document.buffers.push_back(bytesOfBuffer(tree["buffers"][i], i, document, container));
  unpackViews(tree, document);
  for (const json& image : entries("images")) document.images.push_back(imageOf(image));
  document.skins = entries("skins").size();
  document.animations = entries("animations").size();
  for (const char* key : {"buffers", "images", "skins", "animations", "extras"}) tree.erase(key);

  const std::string text = tree.dump();
  tinygltf::TinyGLTF reader;
  std::string error, warning;
  if (!reader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                  static_cast<unsigned int>(text.size()), "")) {
    std::replace(error.begin(), error.end(), '\n', ' ');
    throw InputError(name, 0, "is not glTF 2.0: " + error.substr(0, 200), kExportAgain);
  }
  return document;
}

std::string_view bytesOfView(const GltfDocument& document, int bufferView) {
  const tinygltf::BufferView& view = document.model.bufferViews[static_cast<std::size_t>(bufferView)];
  const std::string_view buffer = document.buffers[static_cast<std::size_t>(view.buffer)];
  if (view.byteOffset > buffer.size() || view.byteLength > buffer.size() - view.byteOffset) {
    throw InputError(document.name, 0,
                     "/bufferViews/" + std::to_string(bufferView) + " reaches beyond its buffer of " +
                         std::to_string(buffer.size()) + " bytes",
                     kExportAgain);
  }
  return buffer.substr(view.byteOffset, view.byteLength);
}

}  // namespace deltalux::io
