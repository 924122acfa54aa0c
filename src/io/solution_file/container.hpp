#pragma once
// The frame of a .dlx file: a head of fixed size, then sections one after the other.
//
//   head     magic (8 bytes: "\x89DLX\r\n\x1a\n", which text transfers spoil), u32 format version, u32 sections,
//            u64 length of the whole file, u32 CRC-32 of the head so far
//   section  tag (4 letters), u64 length of the payload, payload, u32 CRC-32 of tag, length and payload
//
// Every byte is under a checksum, the length tells truncation from damage, and the head keeps this form in all versions
// so that a file from the future is told apart from a damaged one. [PNG 5.2 for the magic]
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "io/solution_file/archive.hpp"

namespace deltalux::io {

inline constexpr std::uint32_t kFormatVersion = 16;

/// Takes the bytes of a file in order, in blocks.
using ByteSink = std::function<void(std::string_view)>;

struct Section {
  std::string_view tag;  // 4 letters
  std::string_view payload;
};

/// The sections of `bytes`, checked. Throws InputError in the name of `file`.
std::vector<Section> openContainer(std::string_view bytes, const std::string& file);

/// Writes a container section by section, with payloads that nobody holds in memory.
class ContainerWriter : public SharedThings {
 public:
  static constexpr bool kReads = false;
  ContainerWriter(const ByteSink&, const std::vector<std::uint64_t>& payloadLengths);

  void beginSection(std::string_view tag, std::uint64_t payloadLength);
  void bytes(const void*, std::size_t);
  void endSection();
  /// The last bytes leave the buffer.
  void flush();

 private:
  void put(const void*, std::size_t);
  void putChecksum();

  const ByteSink& sink_;
  std::string buffer_;
  std::uint32_t checksum_ = 0;
};

}  // namespace deltalux::io
