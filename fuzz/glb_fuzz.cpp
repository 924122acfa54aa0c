// Any document and any binary chunk in a well-formed container: gets past the lengths that stop most random files.
// Input: two bytes for the length of the JSON, the JSON, the binary chunk.
#include <cstdint>
#include <cstring>
#include <deltalux/error.hpp>

#include "io/gltf.hpp"

namespace {

std::string chunk(std::string content, const char* type, char padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  const auto length = static_cast<std::uint32_t>(content.size());
  return std::string(reinterpret_cast<const char*>(&length), 4) + std::string(type, 4) + content;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data + 2), size - 2);
  const std::size_t split = std::min<std::size_t>(data[0] + 256u * data[1], bytes.size());
  const std::string content =
      chunk(std::string(bytes.substr(0, split)), "JSON", ' ') + chunk(std::string(bytes.substr(split)), "BIN\0", '\0');
  const std::uint32_t header[2] = {2, static_cast<std::uint32_t>(12 + content.size())};
  const std::string file = "glTF" + std::string(reinterpret_cast<const char*>(header), 8) + content;
  try {
    validate(deltalux::readGltf(file, "fuzz.glb", "/nonexistent", {}).scene);
  } catch (const deltalux::InputError&) {
  }
  return 0;
}
