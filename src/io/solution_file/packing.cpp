#include "io/solution_file/packing.hpp"

#include <zstd.h>

#include <algorithm>
#include <deltalux/error.hpp>
#include <memory>

#include "base/parallel.hpp"

namespace deltalux::io {

namespace {

constexpr std::size_t kBlock = 1 << 18;  // bytes; shorter ones pack less, longer ones leave threads idle [task]
constexpr std::size_t kWaiting = 64;     // blocks that are packed at once: 16 MB beside the solution [task]
constexpr std::size_t kOfTask = 2;       // blocks that are packed by one thread [task]
constexpr std::size_t kDirect = 8;       // blocks of a table from which on it is not copied first [task]
constexpr std::size_t kTrial = 1 << 13;  // bytes that tell which form of a block is shorter [task]
constexpr int kLevel = 1;                // of zstd; higher ones take twice the time for a few percent [task]
constexpr std::size_t kMostHeld =
    1 << 15;                             // times the packed bytes: zstd's format has four at least for 128 KiB [limit]
constexpr std::size_t kBlockFrame = 12;  // [layout]

/// What zstd works in, for one block after the other.
class Compressor {
 public:
  Compressor() : context_(ZSTD_createCCtx()) {
    if (!context_) throw std::bad_alloc();
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, kLevel);
    ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_checksumFlag, 1);
  }
  std::string operator()(std::string_view bytes) const {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t length = ZSTD_compress2(context_.get(), out.data(), out.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(length)) throw std::bad_alloc();  // there is room, so zstd knows no other failure
    out.resize(length);
    return out;
  }

 private:
  struct Free {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  };
  std::unique_ptr<ZSTD_CCtx, Free> context_;
};

std::string transposed(std::string_view bytes, std::size_t stride) {
  const std::size_t count = bytes.size() / stride;
  std::string out(bytes.size(), '\0');
  for (std::size_t b = 0; b < stride; ++b)
    for (std::size_t i = 0; i < count; ++i) out[b * count + i] = bytes[i * stride + b];
  return out;
}

void appendNumber(std::string& to, std::size_t number) {
  const auto stored = static_cast<std::uint32_t>(number);
  to.append(reinterpret_cast<const char*>(&stored), sizeof stored);
}

std::size_t numberIn(std::string_view bytes, std::size_t at) {
  std::uint32_t number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return number;
}

std::string packBlock(std::string_view bytes, std::size_t stride, const Compressor& compressed) {
  if (stride > 1) {
    const std::string_view trial = bytes.substr(0, std::max(stride, std::min(bytes.size(), kTrial) / stride * stride));
    if (compressed(trial).size() <= compressed(transposed(trial, stride)).size()) stride = 1;
  }
  // What does not pack is a few bytes longer for it, and has a checksum like all else.
  const std::string packed = compressed(stride > 1 ? std::string_view(transposed(bytes, stride)) : bytes);
  std::string block;
  block.reserve(kBlockFrame + packed.size());
  for (const std::size_t number : {packed.size(), bytes.size(), stride}) appendNumber(block, number);
  return block += packed;
}

/// Whether the block holds what it says.
bool unpackBlock(const PackedBlock& block, char* to) {
  std::string planes(block.stride > 1 ? block.length : 0, '\0');
  char* const flat = block.stride > 1 ? planes.data() : to;
  const std::size_t length = ZSTD_decompress(flat, block.length, block.packed.data(), block.packed.size());
  if (ZSTD_isError(length) || length != block.length) return false;
  const std::size_t count = block.length / block.stride;
  if (block.stride > 1)
    for (std::size_t b = 0; b < block.stride; ++b)
      for (std::size_t i = 0; i < count; ++i) to[i * block.stride + b] = planes[b * count + i];
  return true;
}

[[noreturn]] void refusePacking(const std::string& file, const char* what) {
  throw InputError(file, 0, what, "solve the scene again");
}

}  // namespace

void Packer::bytes(const void* data, std::size_t n, std::size_t stride) {
  // Tables of a few records are not worth a block of their own.
  if (n < kTrial || stride > kTrial) stride = 1;
  std::string_view rest(static_cast<const char*>(data), n);
  if (stride != open_.stride) close(), open_.stride = stride;
  const std::size_t block = kBlock / stride * stride;
  if (n >= kDirect * block) {
    // Large tables are packed from where they are.
    close();
    const std::size_t whole = n / block * block;
    packWaiting(rest.substr(0, whole), block, stride);
    rest.remove_prefix(whole);
  }
  while (!rest.empty()) {
    const std::string_view now = rest.substr(0, block - open_.bytes.size());
    open_.bytes += now;
    rest.remove_prefix(now.size());
    if (open_.bytes.size() == block) close();
  }
}

void Packer::close() {
  if (!open_.bytes.empty()) waiting_.push_back({std::move(open_.bytes), open_.stride});
  open_.bytes.clear();
  if (waiting_.size() >= kWaiting) packWaiting({}, 1, 1);
}

void Packer::packWaiting(std::string_view after, std::size_t block, std::size_t stride) {
  std::vector<std::string> blocks(waiting_.size() + after.size() / block);
  parallelBlocks(blocks.size(), kOfTask, [&](std::size_t begin, std::size_t end) {
    const Compressor compressor;
    for (std::size_t i = begin; i < end; ++i)
      blocks[i] = i < waiting_.size()
                      ? packBlock(waiting_[i].bytes, waiting_[i].stride, compressor)
                      : packBlock(after.substr((i - waiting_.size()) * block, block), stride, compressor);
  });
  std::size_t length = packed_.size();
  for (const std::string& b : blocks) length += b.size();
  if (length > packed_.capacity()) packed_.reserve(length + length / 2);
  for (const std::string& b : blocks) packed_ += b;
  waiting_.clear();
}

std::string Packer::finish() {
  close();
  packWaiting({}, 1, 1);
  return std::move(packed_);
}

std::vector<PackedBlock> packedBlocks(std::string_view payload, const std::string& file) {
  std::vector<PackedBlock> blocks;
  while (!payload.empty()) {
    if (payload.size() < kBlockFrame) refusePacking(file, "is damaged: a block is cut short");
    const std::size_t packed = numberIn(payload, 0);
    PackedBlock block{{}, numberIn(payload, 4), numberIn(payload, 8)};
    payload.remove_prefix(kBlockFrame);
    if (packed > payload.size()) refusePacking(file, "is damaged: a block is longer than its section");
    block.packed = payload.substr(0, packed);
    payload.remove_prefix(packed);
    const bool fits = block.stride > 0 && block.length <= kBlock && block.length / kMostHeld <= packed &&
                      block.length % block.stride == 0;
    if (!fits) refusePacking(file, "is damaged: a block cannot hold what it says");
    blocks.push_back(block);
  }
  return blocks;
}

ArchiveReader::ArchiveReader(std::string_view payload, std::string file)
    : file_(std::move(file)), blocks_(packedBlocks(payload, file_)) {
  for (const PackedBlock& b : blocks_) left_ += b.length;
}

void ArchiveReader::fail(const std::string& message) const {
  throw InputError(file_, 0, message, "solve the scene again");
}

void ArchiveReader::bytes(void* to, std::size_t n, std::size_t) {
  require(n <= left_);
  left_ -= n;
  for (char* at = static_cast<char*>(to); n > 0;) {
    if (at_ == open_.size()) {
      const std::size_t done = unpackWhole(at, n);
      at += done, n -= done;
      if (n == 0) return;
      open_.resize(blocks_[next_].length), at_ = 0;
      require(unpackBlock(blocks_[next_++], open_.data()));
    }
    const std::size_t now = std::min(n, open_.size() - at_);
    std::memcpy(at, open_.data() + at_, now);
    at += now, at_ += now, n -= now;
  }
}

std::size_t ArchiveReader::unpackWhole(char* to, std::size_t n) {
  std::vector<std::size_t> places;
  std::size_t total = 0;
  for (std::size_t b = next_; b < blocks_.size() && blocks_[b].length <= n - total; total += blocks_[b++].length)
    places.push_back(total);
  std::vector<char> whole(places.size(), 0);
  parallelFor(places.size(), 1, [&](std::size_t i) { whole[i] = unpackBlock(blocks_[next_ + i], to + places[i]); });
  require(std::find(whole.begin(), whole.end(), 0) == whole.end());
  next_ += places.size();
  return total;
}

}  // namespace deltalux::io
