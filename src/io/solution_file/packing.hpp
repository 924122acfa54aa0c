#pragma once
// Bytes packed in blocks, for the payloads of sections: the bytes of a table's records are put side by side, first
// bytes first (so that exponents stand by exponents), where that packs better, and compressed by zstd at a fast level.
// Blocks are independent of each other, so that all threads pack and unpack them.
//
//   block   u32 length of the packed bytes, u32 length of what they hold, u32 stride, packed bytes
//
// A stride of 1: compressed; more: records of so many bytes, transposed and compressed.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/solution_file/archive.hpp"

namespace deltalux::io {

/// As an archive: takes bytes, gives the payload.
class Packer : public SharedThings {
 public:
  static constexpr bool kReads = false;
  /// `stride`: the size of the records that these bytes are of.
  void bytes(const void* data, std::size_t n, std::size_t stride = 1);
  /// Everything, packed. Ends the packing.
  std::string finish();

 private:
  struct Open {
    std::string bytes;
    std::size_t stride = 1;
  };
  void close();
  /// What waits, and after it whole blocks of so many bytes.
  void packWaiting(std::string_view after, std::size_t block, std::size_t stride);

  Open open_;
  std::vector<Open> waiting_;
  std::string packed_;
};

struct PackedBlock {
  std::string_view packed;
  std::size_t length = 0, stride = 0;  // unpacked
};

/// The blocks of a payload. Throws InputError in the name of `file` when they are none, or claim to hold more than they
/// can.
std::vector<PackedBlock> packedBlocks(std::string_view payload, const std::string& file);

/// As an archive: gives the bytes of a payload; every length is checked against what is left before anything is
/// allocated.
class ArchiveReader : public SharedThings {
 public:
  static constexpr bool kReads = true;
  ArchiveReader(std::string_view payload, std::string file);

  void bytes(void* to, std::size_t n, std::size_t stride = 1);
  std::size_t left() const { return left_; }
  void require(bool holds) const {
    if (!holds) fail("is damaged: its contents do not agree");
  }
  [[noreturn]] void fail(const std::string& message) const;

 private:
  /// The blocks from `next_` on that are wanted whole, to their places.
  std::size_t unpackWhole(char* to, std::size_t n);

  std::string file_;
  std::vector<PackedBlock> blocks_;
  std::size_t next_ = 0, left_ = 0;
  std::string open_;    // the block before `next_`
  std::size_t at_ = 0;  // of it
};

}  // namespace deltalux::io
