// Packed payloads: any bytes come back, in any portions; what cannot be unpacked is refused.
#include "io/solution_file/packing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <deltalux/error.hpp>

#include "base/random.hpp"

namespace deltalux::io {
namespace {

std::string packed(const std::string& bytes, std::size_t stride) {
  Packer packer;
  packer.bytes(bytes.data(), bytes.size(), stride);
  return packer.finish();
}

std::string unpacked(std::string_view payload, std::size_t portion) {
  ArchiveReader reader(payload, "p.dlx");
  std::string bytes(reader.left(), '\0');
  for (std::size_t at = 0; at < bytes.size(); at += portion)
    reader.bytes(bytes.data() + at, std::min(portion, bytes.size() - at));
  EXPECT_EQ(reader.left(), 0u);
  return bytes;
}

std::string noise(std::size_t n) {
  Rng rng(7);
  std::string bytes(n, '\0');
  for (char& c : bytes) c = static_cast<char>(static_cast<int>(256 * rng.uniform()));
  return bytes;
}

/// A table of floats that grow slowly, as tables of places do.
std::string floats(std::size_t count) {
  std::string bytes(count * sizeof(float), '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const float x = std::sqrt(static_cast<float>(i));
    std::memcpy(bytes.data() + i * sizeof x, &x, sizeof x);
  }
  return bytes;
}

TEST(Packing, AnyBytesComeBackInAnyPortions) {
  for (const std::string& bytes :
       {std::string(), std::string("a"), std::string(3000000, 'x'), noise(12 * 70000), floats(300000)})
    for (const std::size_t stride : {1, 3, 4, 12, 100000}) {
      if (bytes.size() % stride != 0) continue;
      const std::string payload = packed(bytes, stride);
      for (const std::size_t portion : {std::size_t(1000), std::size_t(1) << 18, std::size_t(999999), bytes.size() + 1})
        EXPECT_TRUE(unpacked(payload, portion) == bytes) << bytes.size() << " by " << stride;
    }
}

TEST(Packing, TablesAmongNumbersComeBack) {
  const std::string table = floats(200000), small = floats(5);
  Packer packer;
  std::string all;
  for (int i = 0; i < 3; ++i) {
    packer.bytes(small.data(), small.size(), 4), all += small;
    packer.bytes(table.data(), table.size(), 4), all += table;
    packer.bytes("number", 6), all += "number";
  }
  EXPECT_TRUE(unpacked(packer.finish(), 12345) == all);
}

TEST(Packing, PutsTheBytesOfRecordsSideBySideWhereThatIsShorter) {
  const std::string bytes = floats(300000);
  EXPECT_LT(packed(bytes, 4).size(), 3 * packed(bytes, 1).size() / 4);
  EXPECT_LT(packed(noise(1 << 20), 4).size(), (1u << 20) + 4 * 40) << "of what does not get shorter, a frame a block";
  std::string repeated;
  for (int i = 0; i < 20000; ++i) repeated += "over and over, ";
  EXPECT_LE(packed(repeated, 3).size(), packed(repeated, 1).size());
}

/// A block with such a frame around what `bytes` are packed to.
std::string framed(const std::string& bytes, std::uint32_t length, std::uint32_t stride) {
  std::string block = packed(bytes, 1);
  std::memcpy(block.data() + 4, &length, 4);
  std::memcpy(block.data() + 8, &stride, 4);
  return block;
}

bool isRefused(const std::string& payload) {
  try {
    unpacked(payload, 1000);
    return false;
  } catch (const InputError& error) {
    EXPECT_EQ(error.file(), "p.dlx");
    EXPECT_NE(error.message().find("is damaged"), std::string::npos);
    return true;
  }
}

TEST(Packing, WhatDoesNotUnpackToWhatItSaysIsRefused) {
  const std::string zeros(200000, '\0');
  ASSERT_FALSE(isRefused(framed(zeros, 200000, 1)));
  ASSERT_FALSE(isRefused(framed(zeros, 200000, 4)));
  EXPECT_TRUE(isRefused(framed(zeros, 199999, 1))) << "more than it says";
  EXPECT_TRUE(isRefused(framed(zeros, 200001, 1))) << "less than it says";
  EXPECT_TRUE(isRefused(framed(zeros, 200000, 3))) << "no whole records";
  EXPECT_TRUE(isRefused(framed(zeros, 200000, 0))) << "as it is, of another length";
  EXPECT_TRUE(isRefused(framed(zeros, 0xffffffff, 1))) << "longer than any block";
  EXPECT_TRUE(isRefused(framed(std::string(8192, '\0'), 262144, 1))) << "more than there is";
}

TEST(Packing, DamagedPayloadsAreRefused) {
  const std::string payload = packed(noise(9000) + floats(2500), 1);
  ASSERT_FALSE(isRefused(payload));
  for (std::size_t n = 1; n < payload.size(); n += 7) EXPECT_TRUE(isRefused(payload.substr(0, n))) << n;
  std::string flipped = payload;
  const std::string bytes = unpacked(payload, 1000);
  for (std::size_t i = 12; i < payload.size(); i += 11) {
    flipped[i] = static_cast<char>(flipped[i] ^ 0x10);
    // What is packed has a checksum of its own, and some of its bits do not matter.
    EXPECT_TRUE(isRefused(flipped) || unpacked(flipped, 1000) == bytes) << i;
    flipped[i] = payload[i];
  }
}

TEST(Packing, ReadingFurtherThanThereIsSomethingIsRefused) {
  const std::string payload = packed("four", 1);
  ArchiveReader reader(payload, "p.dlx");
  char to[5];
  EXPECT_THROW(reader.bytes(to, 5), InputError);
  EXPECT_THROW(ArchiveReader("short", "p.dlx"), InputError);
}

}  // namespace
}  // namespace deltalux::io
