#include "export/glb_container.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <vector>

#include "base/check.hpp"

namespace deltalux::exporting {

namespace {

static_assert(std::endian::native == std::endian::little, "buffers hold little-endian numbers");

constexpr std::uint32_t kMagic = 0x46546c67, kVersion = 2;                // [defined]
constexpr std::uint32_t kJsonChunk = 0x4e4f534a, kBinChunk = 0x004e4942;  // [defined]
constexpr int kIndexTarget = 34963;                                       // [defined]

void pad(std::string& bytes, char with) { bytes.resize((bytes.size() + 3) / 4 * 4, with); }

void put(std::string& to, std::uint32_t value) { to.append(reinterpret_cast<const char*>(&value), sizeof(value)); }

void putChunk(std::string& to, std::uint32_t kind, const std::string& bytes) {
  put(to, static_cast<std::uint32_t>(bytes.size()));
  put(to, kind);
  to += bytes;
}

std::string packedVertices(std::string_view bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  std::string packed(meshopt_encodeVertexBufferBound(count, stride), '\0');
  meshopt_encodeVertexVersion(0);
  packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), bytes.data(),
                                           count, stride));
  return packed;
}

std::string packedTriangles(std::string_view bytes) {
  const auto* indices = reinterpret_cast<const unsigned int*>(bytes.data());
  const std::size_t count = bytes.size() / sizeof(unsigned int);
  const std::size_t vertices = count > 0 ? *std::max_element(indices, indices + count) + 1u : 0;
  std::string packed(meshopt_encodeIndexBufferBound(count, vertices), '\0');
  meshopt_encodeIndexVersion(1);
  packed.resize(
      meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(packed.data()), packed.size(), indices, count));
  return packed;
}

GlbJson viewOf(std::size_t buffer, std::size_t offset, std::size_t length) {
  return {{"buffer", buffer}, {"byteOffset", offset}, {"byteLength", length}};
}

}  // namespace

std::size_t GlbContainer::append(std::string_view bytes) {
  pad(buffer_, '\0');
  const std::size_t offset = buffer_.size();
  buffer_ += bytes;
  return offset;
}

std::size_t GlbContainer::addView(std::string_view bytes, std::size_t stride, int target) {
  GlbJson view = viewOf(0, append(bytes), bytes.size());
  if (target != 0 && target != kIndexTarget) view["byteStride"] = stride;
  if (target != 0) view["target"] = target;
  return add("bufferViews", std::move(view));
}

std::size_t GlbContainer::addPackedView(std::string_view bytes, std::size_t stride, int target) {
  DELTALUX_CHECK(stride > 0 && stride % 4 == 0 && bytes.size() % stride == 0, "elements of whole words");
  const bool triangles = target == kIndexTarget;
  const std::string packed = triangles ? packedTriangles(bytes) : packedVertices(bytes, stride);
  GlbJson extension = viewOf(0, append(packed), packed.size());
  extension["byteStride"] = stride;
  extension["count"] = bytes.size() / stride;
  extension["mode"] = triangles ? "TRIANGLES" : "ATTRIBUTES";
  GlbJson view = viewOf(1, unpacked_, bytes.size());
  if (!triangles) view["byteStride"] = stride;
  view["target"] = target;
  view["extensions"]["EXT_meshopt_compression"] = std::move(extension);
  unpacked_ += bytes.size();
  use("EXT_meshopt_compression", true);
  return add("bufferViews", std::move(view));
}

std::size_t GlbContainer::add(const char* array, GlbJson member) {
  GlbJson& members = json[array];
  members.push_back(std::move(member));
  return members.size() - 1;
}

void GlbContainer::use(const char* extension, bool required) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (list == std::string_view("extensionsRequired") && !required) continue;
    GlbJson& names = json[list];
    if (std::find(names.begin(), names.end(), extension) == names.end()) names.push_back(extension);
  }
}

std::string GlbContainer::bytes() const {
  std::string buffer = buffer_;
  pad(buffer, '\0');
  GlbJson document = json;
  document["buffers"] = GlbJson::array();
  if (!buffer.empty()) document["buffers"].push_back({{"byteLength", buffer.size()}});
  if (unpacked_ > 0)
    document["buffers"].push_back(
        {{"byteLength", unpacked_}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  std::string text = document.dump(-1, ' ', false, GlbJson::error_handler_t::replace);
  pad(text, ' ');
  const std::size_t chunk = 8, total = 12 + chunk + text.size() + (buffer.empty() ? 0 : chunk + buffer.size());
  if (total > std::numeric_limits<std::uint32_t>::max()) throw std::length_error("a .glb holds less than 4 GB");
  std::string file;
  file.reserve(total);
  put(file, kMagic), put(file, kVersion), put(file, static_cast<std::uint32_t>(total));
  putChunk(file, kJsonChunk, text);
  if (!buffer.empty()) putChunk(file, kBinChunk, buffer);
  return file;
}

}  // namespace deltalux::exporting
