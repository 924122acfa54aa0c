#pragma once
// What the bytes of a case in corpus/glb mean: two bytes for the length of the JSON, the JSON, the binary chunk.
#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

namespace deltalux::fuzz {

inline std::string glbChunk(std::string content, const char* type, char padding) {
  content.resize((content.size() + 3) / 4 * 4, padding);
  const auto length = static_cast<std::uint32_t>(content.size());
  return std::string(reinterpret_cast<const char*>(&length), 4) + std::string(type, 4) + content;
}

/// A well-formed container around both parts.
inline std::string glbOf(std::string_view input) {
  if (input.size() < 2) return {};
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(input[i])); };
  const std::string_view bytes = input.substr(2);
  const std::size_t split = std::min(byte(0) + 256 * byte(1), bytes.size());
  const std::string content = glbChunk(std::string(bytes.substr(0, split)), "JSON", ' ') +
                              glbChunk(std::string(bytes.substr(split)), "BIN\0", '\0');
  const std::uint32_t header[2] = {2, static_cast<std::uint32_t>(12 + content.size())};
  return "glTF" + std::string(reinterpret_cast<const char*>(header), 8) + content;
}

}  // namespace deltalux::fuzz
