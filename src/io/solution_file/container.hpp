#pragma once
// The frame of a .dlx file: a head of fixed size, then sections one after the other.
//
//   head     magic (8 bytes: "\x89DLX\r\n\x1a\n", which text transfers spoil), u32 format version, u32 sections,
//            u64 length of the whole file, u32 CRC-32 of the head so far
//   section  tag (4 letters), u64 length of the payload, payload, u32 CRC-32 of tag, length and payload
//
// Every byte is under a checksum, the length tells truncation from damage, and the head keeps this form in all versions
// so that a file from the future is told apart from a damaged one. [PNG 5.2 for the magic]
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

inline constexpr std::uint32_t kFormatVersion = 24;  // [layout]

/// Takes the bytes of a file in order, in blocks.
using ByteSink = std::function<void(std::string_view)>;

/// A part of a file; its payload is packed (packing.hpp).
struct Section {
  std::string_view tag;  // 4 letters
  std::string_view payload;
};

/// The sections of `bytes`, checked. Throws InputError in the name of `file`.
std::vector<Section> openContainer(std::string_view bytes, const std::string& file);

/// Writes a container of these sections.
void writeContainer(const std::vector<Section>&, const ByteSink&);

}  // namespace deltalux::io
