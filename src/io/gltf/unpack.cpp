#include "io/gltf/unpack.hpp"

#include <meshoptimizer.h>

#include <deltalux/error.hpp>

namespace deltalux::io {

namespace {

using nlohmann::json;
constexpr const char* kMeshopt = "EXT_meshopt_compression";

/// The packed bytes of a view and what is to come of them.
struct PackedView {
  std::string_view bytes;
  std::size_t count = 0, stride = 0;
  std::string mode, filter;
};

PackedView packedView(const json& extension, const GltfDocument& document, const std::string& where) {
  const auto number = [&](const char* key) { return extension.value(key, std::size_t{0}); };
  const std::string_view buffer = document.buffers[number("buffer")];
  if (number("byteOffset") > buffer.size() || number("byteLength") > buffer.size() - number("byteOffset"))
    throw InputError(document.name, 0, where + " reaches beyond its compressed buffer", "export the scene again");
  return {buffer.substr(number("byteOffset"), number("byteLength")), number("count"), number("byteStride"),
          extension.value("mode", ""), extension.value("filter", "NONE")};
}

/// Whether the sizes are ones that a packer can have written: the decoder trusts them.
bool isPlausible(const PackedView& view) {
  constexpr std::size_t kMostBytes = std::size_t{1} << 31, kMostPacked = 256;  // unpacked of each byte [limit]
  if (view.count == 0 || view.stride == 0 || view.count > kMostBytes / view.stride) return false;
  if (view.count * view.stride > kMostPacked * (view.bytes.size() + 1)) return false;
  if (view.mode == "ATTRIBUTES") {
    if (view.stride % 4 != 0 || view.stride > 256) return false;
    if (view.filter == "OCTAHEDRAL") return view.stride == 4 || view.stride == 8;
    if (view.filter == "QUATERNION") return view.stride == 8;
    return view.filter == "NONE" || view.filter == "EXPONENTIAL";
  }
  if (view.filter != "NONE" || (view.stride != 2 && view.stride != 4)) return false;
  return view.mode == "INDICES" || (view.mode == "TRIANGLES" && view.count % 3 == 0);
}

std::optional<std::string> unpacked(const PackedView& view) {
  if (!isPlausible(view)) return std::nullopt;
  std::string bytes(view.count * view.stride, '\0');
  const auto* packed = reinterpret_cast<const unsigned char*>(view.bytes.data());
  const std::size_t size = view.bytes.size();
  int error = 0;
  if (view.mode == "ATTRIBUTES")
    error = meshopt_decodeVertexBuffer(bytes.data(), view.count, view.stride, packed, size);
  else if (view.mode == "TRIANGLES")
    error = meshopt_decodeIndexBuffer(bytes.data(), view.count, view.stride, packed, size);
  else
    error = meshopt_decodeIndexSequence(bytes.data(), view.count, view.stride, packed, size);
  if (error != 0) return std::nullopt;
  if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), view.count, view.stride);
  if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), view.count, view.stride);
  if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), view.count, view.stride);
  return bytes;
}

}  // namespace

bool isFallback(const json& buffer) {
  if (buffer.contains("uri") || !buffer.contains("extensions")) return false;
  const json& extensions = buffer.at("extensions");
  return extensions.contains(kMeshopt) && extensions.at(kMeshopt).value("fallback", false);
}

void unpackViews(json& tree, GltfDocument& document) {
  if (!tree.contains("bufferViews") || !tree.contains("buffers")) return;
  const std::size_t buffers = tree.at("buffers").size();
  json& views = tree["bufferViews"];
  for (std::size_t i = 0; i < views.size(); ++i) {
    json& view = views[i];
    const auto buffer = view.at("buffer").get<std::size_t>();
    if (buffer >= buffers || !isFallback(tree.at("buffers")[buffer])) continue;
    const std::string where = "/bufferViews/" + std::to_string(i);
    if (!view.contains("extensions") || !view.at("extensions").contains(kMeshopt))
      throw InputError(document.name, 0, where + " has no data", "export the scene again without compression");
    std::optional<std::string> bytes = unpacked(packedView(view.at("extensions").at(kMeshopt), document, where));
    if (!bytes)
      throw InputError(document.name, 0, where + " cannot be unpacked by EXT_meshopt_compression",
                       "export the scene again without compression");
    view["buffer"] = document.buffers.size(), view["byteOffset"] = 0, view["byteLength"] = bytes->size();
    document.buffers.push_back(std::move(*bytes));
  }
}

}  // namespace deltalux::io
